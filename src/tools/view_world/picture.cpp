#include "picture.h"

#include <fmt/format.h>
#include <signal.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "blem_sim/geometry/input_error.h"
#include "virtual_display.h"

namespace blem_sim {

namespace {

/** A word of a shell's command line. */
std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char letter : text) word += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return word + "'";
}

/** Its input takes pictures, lowest row first; no other child has it, so that it ends where we close it. */
std::FILE* startFfmpeg(const ViewOptions& options) {
  if (!isInstalled("ffmpeg"))
    throw InputError(fmt::format("{}: ffmpeg is not installed: apt install ffmpeg, or give a folder for the pictures", options.output));
  // A film that cannot be written is told by ffmpeg's exit status.
  signal(SIGPIPE, SIG_IGN);
  const std::string file = std::filesystem::absolute(options.output).string();
  return popen(
      fmt::format("ffmpeg -y -loglevel error -f rawvideo -pix_fmt rgb24 -s {}x{} -r {} -i - -vf vflip -c:v libx264 -pix_fmt yuv420p "
                  "-fflags +bitexact {}",
                  options.size.width, options.size.height, options.fps, quoted(file))
          .c_str(),
      "we");
}

}  // namespace

Picture halved(const Picture& picture) {
  Picture half{{picture.size.width / 2, picture.size.height / 2}, {}};
  half.pixels.reserve(picture.pixels.size() / 4);
  const std::size_t row = 3 * static_cast<std::size_t>(picture.size.width);
  for (int y = 0; y < half.size.height; ++y) {
    for (int x = 0; x < half.size.width; ++x) {
      const std::uint8_t* pixel = &picture.pixels[2 * static_cast<std::size_t>(y) * row + 6 * static_cast<std::size_t>(x)];
      for (int i = 0; i < 3; ++i)
        half.pixels.push_back(static_cast<std::uint8_t>((pixel[i] + pixel[i + 3] + pixel[i + row] + pixel[i + row + 3] + 2) / 4));
    }
  }
  return half;
}

void writePng(const Picture& picture, const std::string& file) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(picture.size.width, picture.size.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  std::copy(picture.pixels.begin(), picture.pixels.end(), static_cast<std::uint8_t*>(image->GetScalarPointer()));
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image.GetPointer());
  writer->SetCompressionLevel(9);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes->GetPointer(0)), bytes->GetNumberOfTuples());
  stream.close();
  if (!stream) throw InputError(fmt::format("{}: cannot be written; check the folder", file));
}

PictureWriter::PictureWriter(const ViewOptions& options) : options_(options) {
  if (!options.video) return;
  if (isFilm(options.output)) {
    film_ = startFfmpeg(options);
    return;
  }
  std::error_code failure;
  std::filesystem::create_directory(options.output, failure);
  if (failure) throw InputError(fmt::format("{}: this folder cannot be made: {}", options.output, failure.message()));
}

PictureWriter::~PictureWriter() {
  if (film_) pclose(film_);
}

void PictureWriter::add(const Picture& picture) {
  if (film_) {
    std::fwrite(picture.pixels.data(), 1, picture.pixels.size(), film_);
  } else {
    writePng(picture, options_.video ? fmt::format("{}/frame_{:05d}.png", options_.output, count_++) : options_.output);
  }
}

void PictureWriter::finish() {
  if (!film_) return;
  const int status = pclose(film_);
  film_ = nullptr;
  if (status != 0) throw InputError(fmt::format("{}: ffmpeg could not write it; check the folder", options_.output));
}

}  // namespace blem_sim
