#include "apps/tactus/screenshot.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <thread>
#include <vector>

#include "framework/runtime/file_error.h"
#include "framework/runtime/temporary_folder.h"

namespace tactus::app {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::minutes patience{5};                        // without a graphics card, on a busy machine

/// Path of the first that there is; "" without any.
std::string findBrowser() {
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
    for (std::string rest = path ? path : ""; !rest.empty();) {
      const size_t end = rest.find(':');
      const std::string candidate = rest.substr(0, end) + "/" + name;
      if (::access(candidate.c_str(), X_OK) == 0) return candidate;
      rest = end == std::string::npos ? "" : rest.substr(end + 1);
    }
  return "";
}

/// Starts a program in a process group of its own, silent; 0 when it cannot be started.
pid_t start(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&files, descriptor, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t process = 0;
  const int error = ::posix_spawn(&process, arguments[0], &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return error == 0 ? process : 0;
}

/// Whether it ended by itself in time; otherwise it is ended, with what it started.
bool waitFor(pid_t process) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (::waitpid(process, nullptr, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > deadline) {
      ::kill(-process, SIGKILL);
      ::waitpid(process, nullptr, 0);
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

}  // namespace

std::string fileAddress(const std::string& path) {
  std::string address = "file://";
  for (const char c : fs::absolute(path).lexically_normal().string()) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = std::isalnum(byte) || std::string_view("/-._~").find(c) != std::string_view::npos;
    address += plain ? std::string(1, c) : std::string{'%', "0123456789ABCDEF"[byte >> 4], "0123456789ABCDEF"[byte & 15]};
  }
  return address;
}

void takeScreenshot(const std::string& address, const std::string& png, PictureSize size) {
  const std::string browser = findBrowser();
  if (browser.empty())
    throw runtime::FileError(png, "cannot be made: pictures need Chromium, and there is none on the path; on Debian: "
                                  "apt-get install chromium");
  const runtime::TemporaryFolder profile;
  const std::string picture = profile.path + "/picture.png";
  std::vector<std::string> words{browser, "--headless", "--screenshot=" + picture,
                                 "--window-size=" + std::to_string(size.width) + "," + std::to_string(size.height),
                                 "--force-device-scale-factor=2", "--hide-scrollbars", "--use-angle=swiftshader",
                                 "--enable-unsafe-swiftshader", "--user-data-dir=" + profile.path, "--no-first-run",
                                 "--disable-background-networking", "--disable-component-update", "--disable-sync",
                                 "--virtual-time-budget=3000", address};
  if (::geteuid() == 0) words.insert(words.begin() + 1, "--no-sandbox");  // Chromium refuses root a sandbox
  const pid_t process = start(words);
  if (process == 0) throw runtime::FileError(png, "cannot be made: " + browser + " does not start");
  if (!waitFor(process)) throw runtime::FileError(png, "cannot be made: " + browser + " took longer than five minutes");
  if (!fs::exists(picture)) throw runtime::FileError(png, "cannot be made: " + browser + " made no picture of " + address);
  runtime::writeFile(png, runtime::readFile(picture));
}

}  // namespace tactus::app
