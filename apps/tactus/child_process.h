#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace tactus::app {

/// How a process ended: by itself, or by a signal.
struct ProcessEnd {
  int exit_code = 0;
  int signal = 0;                                                  ///< 0 = none
};

/// Another run of this very program, beside this one.  It does not outlive its parent, however that ends.
class ChildProcess {
 public:
  /// `arguments` follow the program's name; what it says goes into the file `talk`, its data nowhere.  Mathematics
  /// libraries take one thread, unless the user's environment says otherwise: there is a process for each core.
  /// Throws FileError.
  ChildProcess(const std::vector<std::string>& arguments, const std::string& talk);
  /// Ends it at once when it is still running.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Nothing while it runs; its end is told once.
  std::optional<ProcessEnd> ended();

 private:
  pid_t process_ = -1;
};

}  // namespace tactus::app
