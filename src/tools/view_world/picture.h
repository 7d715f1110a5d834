// Pictures: pixels, PNG files, films.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "view_options.h"

namespace blem_sim {

/** Rows of red, green and blue, the lowest row first. */
struct Picture {
  PictureSize size;
  std::vector<std::uint8_t> pixels;
};

/** Picture of half the width and height: each pixel is the mean of four. */
Picture halved(const Picture& picture);

/** @throws InputError if the file cannot be written */
void writePng(const Picture& picture, const std::string& file);

/** Place where the pictures of a run go: one PNG, a folder of them, or a film. */
class PictureWriter {
 public:
  /** @throws InputError: ffmpeg is not installed, a folder that cannot be made */
  explicit PictureWriter(const ViewOptions& options);
  ~PictureWriter();
  PictureWriter(const PictureWriter&) = delete;
  PictureWriter& operator=(const PictureWriter&) = delete;
  void add(const Picture& picture);
  /** @throws InputError if the film could not be written */
  void finish();

 private:
  const ViewOptions& options_;
  int count_ = 0;
  std::FILE* film_ = nullptr;  // ffmpeg's input
};

}  // namespace blem_sim
