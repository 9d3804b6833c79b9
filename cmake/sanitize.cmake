# -DDEMO_LOGGER_SANITIZE=address|thread instruments everything that is built here; scripts/test.sh --sanitize sets it.
set(DEMO_LOGGER_SANITIZE "none" CACHE STRING "none, address (with undefined behaviour and leaks) or thread")
set_property(CACHE DEMO_LOGGER_SANITIZE PROPERTY STRINGS none address thread)

if(DEMO_LOGGER_SANITIZE STREQUAL "address")
  set(sanitizers -fsanitize=address,undefined -fno-sanitize-recover=undefined)
elseif(DEMO_LOGGER_SANITIZE STREQUAL "thread")
  set(sanitizers -fsanitize=thread)
elseif(NOT DEMO_LOGGER_SANITIZE STREQUAL "none")
  message(FATAL_ERROR "DEMO_LOGGER_SANITIZE is \"${DEMO_LOGGER_SANITIZE}\", expected none, address or thread")
endif()
if(sanitizers)
  # Lightly optimised, as instrumented code compiles slowly; with the assertions of ours and of Eigen.
  add_compile_options(${sanitizers} -fno-omit-frame-pointer -O1 -g1 -UNDEBUG)
  add_link_options(${sanitizers})
endif()
