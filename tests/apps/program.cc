#include "tests/apps/program.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>

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

namespace {

std::string settingsOf(int terminal) {
  termios settings{};
  if (::tcgetattr(terminal, &settings) != 0) return "";
  return std::to_string(settings.c_iflag) + " " + std::to_string(settings.c_oflag) + " " +
         std::to_string(settings.c_cflag) + " " + std::to_string(settings.c_lflag);
}

}  // namespace

ProgramInTerminal::ProgramInTerminal(const std::vector<std::string>& arguments) {
  const std::string program = std::string(TACTUS_BINARY_DIR) + "/bin/tactus";
  std::vector<char*> words{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  winsize size{};
  size.ws_col = 80;
  size.ws_row = 24;
  process_ = ::forkpty(&terminal_, nullptr, nullptr, &size);
  if (process_ == 0) {
    ::execv(program.c_str(), words.data());
    ::_exit(127);
  }
  settings_ = settingsOf(terminal_);
}

ProgramInTerminal::~ProgramInTerminal() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  ::close(terminal_);
}

bool ProgramInTerminal::read(int milliseconds) {
  pollfd readable{terminal_, POLLIN, 0};
  if (::poll(&readable, 1, milliseconds) <= 0) return true;
  char part[4096];
  const ssize_t count = ::read(terminal_, part, sizeof part);  // fails when nobody writes into it any more
  if (count <= 0) return false;
  output_.append(part, static_cast<size_t>(count));
  return true;
}

void ProgramInTerminal::type(const std::string& keys) {
  EXPECT_EQ(::write(terminal_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
}

void ProgramInTerminal::send(int signal) { ::kill(process_, signal); }

int ProgramInTerminal::wait() {
  while (read(1000)) {
  }
  int status = 0;
  ::waitpid(process_, &status, 0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool ProgramInTerminal::settingsAreOrdinary() const { return !settings_.empty() && settingsOf(terminal_) == settings_; }

std::vector<std::string> screenOf(const std::string& output, size_t width) {
  std::vector<std::vector<std::string>> lines(1);                  // of characters
  size_t row = 0, column = 0;
  for (size_t i = 0; i < output.size(); ++i) {
    const auto byte = static_cast<unsigned char>(output[i]);
    if (byte == '\r') {
      column = 0;
    } else if (byte == '\n') {
      if (++row == lines.size()) lines.emplace_back();
    } else if (byte == 27) {
      size_t end = i + 2;
      while (end < output.size() && std::isdigit(static_cast<unsigned char>(output[end]))) ++end;
      const std::string number = output.substr(std::min(i + 2, output.size()), end - i - 2);
      const char kind = end < output.size() ? output[end] : 'A';
      if (kind == 'A') {
        const size_t up = number.empty() ? 1 : std::stoul(number);
        EXPECT_LE(up, row) << "above the first line";
        row -= std::min(up, row);
      } else {
        EXPECT_TRUE(kind == 'K' || kind == 'J') << "ESC[" << number << kind;
        lines[row].resize(std::min(lines[row].size(), column));
        if (kind == 'J') lines.resize(row + 1);
      }
      i = end;
    } else {
      std::string character(1, output[i]);
      while (i + 1 < output.size() && (static_cast<unsigned char>(output[i + 1]) & 0xC0) == 0x80)
        character += output[++i];
      EXPECT_LT(column, width) << "the line wraps";
      lines[row].resize(std::max(lines[row].size(), column + 1), " ");
      lines[row][column++] = character;
    }
  }
  std::vector<std::string> texts;
  for (const auto& line : lines) {
    texts.emplace_back();
    for (const std::string& character : line) texts.back() += character;
  }
  return texts;
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
