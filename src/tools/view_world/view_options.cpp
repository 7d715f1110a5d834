#include "view_options.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <locale>
#include <sstream>

#include "blem_sim/geometry/input_error.h"
#include "command_line.h"

namespace blem_sim {

const char* const VIEW_USAGE = R"(Draws a world without rviz and without a display.

view_world CONFIG.yaml OUT.png [options]
  CONFIG.yaml             as blem_sim_run takes it
  OUT.png                 the picture; with --video a film (.mp4, by ffmpeg) or a folder for frame_00000.png, frame_00001.png ...
  --at T                  [s] simulated before the picture is taken (0: as configured)
  --contacts              contacts of the last step as points, and their forces as arrows, before everything else: green at no depth,
                          yellow where the boundary layers are used up, red beyond; the weight of all that moves is an arrow
                          of a quarter of the camera's distance
  --layers                boundary layers as translucent shells
  --camera X,Y,Z,TX,TY,TZ where the eye is and what it looks at [m]; without it what moves fills the picture
  --size WxH              [pixels], even numbers (960x720)
  --video                 from 0 to T, seen by one camera
  --fps N                 pictures per simulated second of a video (25)
  --trajectory FILE.csv   as for blem_sim_run
  --set KEY.PATH=VALUE    as for blem_sim_run
  --package NAME=DIR      as for blem_sim_run
  --help                  this text
Robots, objects and environments are drawn as they are touched: the shapes that contact uses, not a URDF's visuals.
Exit status: 0 drawn; 1 something failed, 2 bad input, told in one line.
)";

namespace {

/** Numbers of a list, all finite, as many as asked for; empty if it is no such list. */
std::vector<double> numbersOf(const std::string& text, char separator, std::size_t count) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  std::vector<double> numbers;
  for (double number = 0; stream >> number && std::isfinite(number);) {
    numbers.push_back(number);
    if (numbers.size() == count || stream.peek() != separator) break;
    stream.get();
  }
  const bool whole = numbers.size() == count && stream.peek() == std::istringstream::traits_type::eof();
  return whole ? numbers : std::vector<double>();
}

ViewCamera cameraOf(const std::string& option, const std::string& text) {
  const std::vector<double> n = numbersOf(text, ',', 6);
  if (n.empty()) throw InputError(fmt::format("{}: '{}' is not x,y,z,tx,ty,tz: six numbers [m]", option, text));
  const ViewCamera camera{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
  if ((camera.eye - camera.target).norm() < 1e-6) throw InputError(fmt::format("{}: '{}': the eye is where it looks at", option, text));
  return camera;
}

PictureSize sizeOf(const std::string& option, const std::string& text) {
  const std::vector<double> n = numbersOf(text, 'x', 2);
  const auto suits = [](double pixels) { return pixels >= 16 && pixels <= 4096 && std::fmod(pixels, 2) == 0; };
  if (n.empty() || !suits(n[0]) || !suits(n[1]))
    throw InputError(fmt::format("{}: '{}' is not WIDTHxHEIGHT of even numbers from 16 to 4096", option, text));
  return {static_cast<int>(n[0]), static_cast<int>(n[1])};
}

double pictureRate(const std::string& option, const std::string& text) {
  const double rate = numberOf(option, text);
  if (rate < 0.1 || rate > 1000) throw InputError(fmt::format("{}: '{}' is not a number from 0.1 to 1000", option, text));
  return rate;
}

const OptionTable<ViewOptions>& optionTable() {
  static const OptionTable<ViewOptions> table = {
      {"--at", number(&ViewOptions::at)},
      {"--trajectory", text(&ViewOptions::trajectory)},
      {"--camera", [](ViewOptions& o, const std::string& option, const std::string& value) { o.camera = cameraOf(option, value); }},
      {"--size", [](ViewOptions& o, const std::string& option, const std::string& value) { o.size = sizeOf(option, value); }},
      {"--fps", [](ViewOptions& o, const std::string& option, const std::string& value) { o.fps = pictureRate(option, value); }},
      {"--set",
       [](ViewOptions& o, const std::string& option, const std::string& value) { o.settings.push_back(assignment(option, value)); }},
      {"--package",
       [](ViewOptions& o, const std::string& option, const std::string& value) { o.packages.insert(assignment(option, value)); }},
  };
  return table;
}

void checkOutput(const ViewOptions& options) {
  if (options.output.empty()) throw InputError("OUT.png is empty; give the picture's name");
  const std::filesystem::path output(options.output);
  const bool folder = std::filesystem::is_directory(output);
  const std::filesystem::path parent = std::filesystem::absolute(output).parent_path();
  if (!std::filesystem::is_directory(parent)) throw InputError(fmt::format("{}: there is no folder {}", options.output, parent.string()));
  if (!options.video && (folder || output.extension() != ".png"))
    throw InputError(fmt::format("{}: a picture's name ends in .png; --video makes more than one", options.output));
  if (options.video && !folder && std::filesystem::exists(output) && !isFilm(options.output))
    throw InputError(fmt::format("{}: is a file; --video takes a folder or a name that ends in .mp4", options.output));
}

}  // namespace

bool isFilm(const std::string& output) { return std::filesystem::path(output).extension() == ".mp4"; }

ViewOptions parseViewOptions(const std::vector<std::string>& arguments) {
  ViewOptions options;
  const FlagTable<ViewOptions> flags = {
      {"--contacts", &ViewOptions::contacts}, {"--layers", &ViewOptions::layers}, {"--video", &ViewOptions::video}};
  const std::vector<std::string> files = readArguments(arguments, optionTable(), flags, &options);
  if (options.help) return options;
  if (files.size() != 2) throw InputError(fmt::format("{} files, but CONFIG.yaml and OUT.png are needed; --help says more", files.size()));
  options.config = files[0];
  options.output = files[1];
  checkOutput(options);
  return options;
}

}  // namespace blem_sim
