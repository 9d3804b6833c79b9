#include "src/tool/output_plan.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <system_error>
#include <thread>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/trajectory/error.h"
#include "src/tool/recordings.h"

namespace demo_logger {
namespace {

/// Files that something must not be written to, by their places, with what they are.
using Places = std::map<std::filesystem::path, std::string>;

std::filesystem::path placeOf(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(file, error);
  const std::filesystem::path place = std::filesystem::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : place;
}

void refuseIfAmong(const Places& places, const std::filesystem::path& file) {
  const auto found = places.find(placeOf(file));
  if (found == places.end()) return;
  throw FileError(file.string() + ": would overwrite " + found->second +
                  ", which --force does not allow either; choose another name");
}

}  // namespace

std::vector<InputAndOutput> planOutputs(const std::vector<std::string>& inputs, const std::filesystem::path& output,
                                        bool force) {
  const std::vector<std::filesystem::path> files = findRecordings(inputs);
  const bool into_directory = files.size() > 1 || std::filesystem::is_directory(output) || !output.has_filename();
  if (into_directory && std::filesystem::exists(output) && !std::filesystem::is_directory(output)) {
    throw FileError(output.string() + ": is a file, expected a directory for the results of " +
                    std::to_string(files.size()) + " inputs");
  }
  std::vector<InputAndOutput> plan;
  std::map<std::filesystem::path, std::filesystem::path> taken;
  for (const std::filesystem::path& input : files) {
    plan.push_back({input, into_directory ? output / input.filename() : output});
    const auto [other, is_new] = taken.emplace(plan.back().output, input);
    if (!is_new) {
      throw FileError(input.string() + " and " + other->second.string() + " would both become " +
                      plan.back().output.string() + "; rename one of them, or run them one by one");
    }
    if (!force) refuseToOverwrite(plan.back().output);
  }
  return plan;
}

void refuseToOverwrite(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::symlink_status(file, error).type() == std::filesystem::file_type::not_found) return;
  throw FileError(file.string() + ": exists already and is not overwritten; choose another name, or add --force");
}

void refuseToDestroy(const std::vector<InputAndOutput>& plan, const std::vector<std::string>& also_read,
                     const std::string& also_written) {
  Places read;
  for (const std::string& file : also_read) {
    if (!file.empty()) read.emplace(placeOf(file), "the input " + file);
  }
  for (const InputAndOutput& entry : plan) {
    const std::filesystem::path sidecar = sidecarPath(entry.input);
    read.emplace(placeOf(entry.input), "the input " + entry.input.string());
    if (std::filesystem::exists(sidecar)) {
      read.emplace(placeOf(sidecar), "the sidecar of the input " + entry.input.string());
    }
  }
  Places written;
  for (const InputAndOutput& entry : plan) {
    refuseIfAmong(read, entry.output);
    refuseIfAmong(read, sidecarPath(entry.output));
    const std::string output = "the output " + entry.output.string();
    const auto [other, is_new] = written.emplace(placeOf(sidecarPath(entry.output)), "the sidecar of " + output);
    if (!is_new) {
      throw FileError("the sidecar of " + output + " and " + other->second + " would both become " +
                      sidecarPath(entry.output).string() + "; rename an input, or run them one by one");
    }
    written.emplace(placeOf(entry.output), output);
  }
  if (also_written.empty()) return;
  refuseIfAmong(read, also_written);
  refuseIfAmong(written, also_written);
}

void makeDirectories(const std::vector<InputAndOutput>& plan) {
  for (const InputAndOutput& entry : plan) {
    const std::filesystem::path directory = entry.output.parent_path();
    if (directory.empty()) continue;
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error) throw FileError(directory.string() + ": cannot be created (" + error.message() + ")");
  }
}

void runJobs(std::size_t count, unsigned jobs, const std::function<void(std::size_t)>& work) {
  std::vector<std::exception_ptr> errors(count);
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  const auto worker = [&] {
    while (!failed) {
      const std::size_t i = next++;
      if (i >= count) return;
      try {
        work(i);
      } catch (...) {
        errors[i] = std::current_exception();
        failed = true;
      }
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < std::min<std::size_t>(jobs, count); ++i) threads.emplace_back(worker);
  worker();
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace demo_logger
