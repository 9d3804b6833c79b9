#include "demo_logger/trajectory/column.h"

namespace demo_logger {

const char* toString(Role role) {
  switch (role) {
    case Role::state:
      return "state";
    case Role::control:
      return "control";
    case Role::auxiliary:
      return "auxiliary";
  }
  return "auxiliary";
}

const char* toString(Interpolation interpolation) {
  switch (interpolation) {
    case Interpolation::linear:
      return "linear";
    case Interpolation::slerp:
      return "slerp";
    case Interpolation::hold:
      return "hold";
    case Interpolation::none:
      return "none";
  }
  return "none";
}

std::optional<Role> roleFromString(std::string_view word) {
  for (const Role role : {Role::state, Role::control, Role::auxiliary}) {
    if (word == toString(role)) {
      return role;
    }
  }
  return std::nullopt;
}

std::optional<Interpolation> interpolationFromString(std::string_view word) {
  for (const Interpolation interpolation :
       {Interpolation::linear, Interpolation::slerp, Interpolation::hold, Interpolation::none}) {
    if (word == toString(interpolation)) {
      return interpolation;
    }
  }
  return std::nullopt;
}

}  // namespace demo_logger
