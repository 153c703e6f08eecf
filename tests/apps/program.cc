#include "tests/apps/program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tactus::testing {

RunningProgram::RunningProgram(const std::vector<std::string>& arguments, const Settings& settings) {
  const std::string program = std::string(TACTUS_BINARY_DIR) + "/bin/tactus";
  std::vector<char*> words{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  const std::string out = settings.out.empty() ? output_.file("out") : settings.out, err = output_.file("err");
  process_ = ::fork();
  if (process_ != 0) return;
  for (const std::string& variable : settings.environment) ::putenv(const_cast<char*>(variable.c_str()));
  ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
  ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
  if (settings.largest_file >= 0) {
    const rlim_t bytes = static_cast<rlim_t>(settings.largest_file);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::signal(SIGXFSZ, SIG_IGN);
  }
  if (::chdir(settings.working_folder.c_str()) == 0) ::execv(program.c_str(), words.data());
  ::_exit(127);
}

RunningProgram::~RunningProgram() {
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

void RunningProgram::send(int signal) { ::kill(process_, signal); }

Outcome RunningProgram::wait() {
  int status = 0;
  ::waitpid(process_, &status, 0);
  process_ = -1;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, contentOf(output_.file("out")), contentOf(output_.file("err"))};
}

Outcome tactus(const std::vector<std::string>& arguments, const Settings& settings) {
  return RunningProgram(arguments, settings).wait();
}

std::string data(const std::string& name) { return std::string(TACTUS_SOURCE_DIR) + "/tests/apps/data/" + name; }

std::string changedStack(const TemporaryFolder& folder, const std::string& from, const std::string& to) {
  std::string stack = contentOf(data("press.xml"));
  const size_t at = stack.find(from);
  EXPECT_NE(at, std::string::npos) << "the stack has no " << from;
  stack.replace(at, from.size(), to);
  folder.write("finger.urdf", contentOf(data("finger.urdf")));
  return folder.write("stack.xml", stack);
}

}  // namespace tactus::testing
