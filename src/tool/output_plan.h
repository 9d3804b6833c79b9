#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace demo_logger {

struct InputAndOutput {
  std::filesystem::path input;
  std::filesystem::path output;
};

/// Where the result of each input goes: to `output` itself if there is one input and `output` is no directory, else
/// into the directory `output` under the input's name. Directories among `inputs` stand for the *.csv in them. Throws
/// FileError for an input that is not there, two that would get one name, and an output that is there already, unless
/// `force`.
std::vector<InputAndOutput> planOutputs(const std::vector<std::string>& inputs, const std::filesystem::path& output,
                                        bool force);

/// Throws FileError if something has that name already, be it a link to nothing.
void refuseToOverwrite(const std::filesystem::path& file);

/// Throws FileError if anything that is written is among what is read, or `also_written` among the outputs: that would
/// destroy what was recorded or just made, so --force does not allow it. Recordings count with their sidecars;
/// `also_read` and `also_written` may be empty.
void refuseToDestroy(const std::vector<InputAndOutput>& plan, const std::vector<std::string>& also_read,
                     const std::string& also_written);

/// The directories that the plan's outputs need; to be called when everything that can fail is done.
void makeDirectories(const std::vector<InputAndOutput>& plan);

/// Calls work(i) for each i below `count`, up to `jobs` at a time; once one has thrown no new one is begun, and the
/// error of the lowest index is thrown again.
void runJobs(std::size_t count, unsigned jobs, const std::function<void(std::size_t)>& work);

}  // namespace demo_logger
