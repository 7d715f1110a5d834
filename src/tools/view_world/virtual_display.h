// An X server of its own for a program that draws where nobody looks.
#pragma once

#include <sys/types.h>

#include <string>

namespace blem_sim {

/** Whether a program of this name is on the path. */
bool isInstalled(const std::string& program);

/**
 * Starts Xvfb for the life of the object, and points DISPLAY at it; OpenGL is Mesa's in software: pictures are the same with and without a
 * display and a graphics card. One at a time.
 */
class VirtualDisplay {
 public:
  /** @param width, height [pixels] of the screen @throws InputError if Xvfb is not installed, std::runtime_error if it does not start */
  VirtualDisplay(int width, int height);
  ~VirtualDisplay();
  VirtualDisplay(const VirtualDisplay&) = delete;
  VirtualDisplay& operator=(const VirtualDisplay&) = delete;

 private:
  void stop();

  pid_t server_ = -1;
};

}  // namespace blem_sim
