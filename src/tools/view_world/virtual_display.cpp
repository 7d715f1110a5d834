#include "virtual_display.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim {

namespace {

constexpr int PATIENCE = 20000;  // [ms]

/** In the child: becomes the X server, which writes the number of its display to a file descriptor. Ends with its parent. */
[[noreturn]] void becomeServer(int numbers, const std::string& screen) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
  const std::string descriptor = std::to_string(numbers);
  execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", screen.c_str(), "-nolisten", "tcp", "-noreset",
         static_cast<char*>(nullptr));
  _exit(127);
}

/** Line that a descriptor gives; empty if it ends or nothing comes in time. */
std::string readLine(int descriptor) {
  std::string line;
  pollfd waited{descriptor, POLLIN, 0};
  for (char letter = 0; poll(&waited, 1, PATIENCE) == 1 && read(descriptor, &letter, 1) == 1;) {
    if (letter == '\n') return line;
    line += letter;
  }
  return "";
}

}  // namespace

bool isInstalled(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

VirtualDisplay::VirtualDisplay(int width, int height) {
  if (!isInstalled("Xvfb")) throw InputError("Xvfb is not installed, which pictures are drawn in: apt install xvfb");
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("Xvfb: no pipe to it");
  server_ = fork();
  if (server_ == 0) {
    close(ends[0]);
    becomeServer(ends[1], fmt::format("{}x{}x24", width, height));
  }
  close(ends[1]);
  const std::string display = server_ > 0 ? readLine(ends[0]) : "";
  close(ends[0]);
  if (display.empty()) {
    stop();
    throw std::runtime_error("Xvfb does not start");
  }
  setenv("DISPLAY", (":" + display).c_str(), 1);
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
}

VirtualDisplay::~VirtualDisplay() { stop(); }

void VirtualDisplay::stop() {
  if (server_ <= 0) return;
  kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
}

}  // namespace blem_sim
