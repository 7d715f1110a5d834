// The command line of view_world.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "view_camera.h"

namespace blem_sim {

struct PictureSize {
  int width = 960, height = 720;  ///< [pixels], even
};

struct ViewOptions {
  bool help = false;
  std::string config, output;
  double at = 0;  ///< [s] simulated
  bool contacts = false, layers = false, video = false;
  std::optional<ViewCamera> camera;
  PictureSize size;
  double fps = 25;                                            ///< pictures per simulated second of a video
  std::vector<std::pair<std::string, std::string>> settings;  ///< --set key.path=value, in order
  std::map<std::string, std::string> packages;
  std::string trajectory;
};

extern const char* const VIEW_USAGE;

/** @throws InputError for an unknown option, a missing or malformed value, no configuration, an output that cannot be */
ViewOptions parseViewOptions(const std::vector<std::string>& arguments);

/** Whether the output is a film by ffmpeg, not a folder of pictures. */
bool isFilm(const std::string& output);

}  // namespace blem_sim
