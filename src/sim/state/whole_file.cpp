#include "state/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::sim {

namespace {

/** An open file or folder. */
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool isOpen() const { return number_ >= 0; }
  bool write(const std::string& bytes) const {
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t written = ::write(number_, bytes.data() + at, bytes.size() - at);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return false;
      at += static_cast<std::size_t>(written);
    }
    return true;
  }
  bool sync() const { return ::fsync(number_) == 0; }

 private:
  int number_;
};

std::string folderOf(const std::string& file) {
  const std::size_t slash = file.rfind('/');
  return slash == std::string::npos ? "." : file.substr(0, slash + 1);
}

/** @throws InputError for a folder, a pipe or a device: the whole file would take its place, /dev/null's too where root runs this */
void checkReplaceable(const std::string& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    throw InputError(fmt::format("{}: cannot be written: it is no file; give the name of a file", file));
}

}  // namespace

void writeWhole(const std::string& file, const std::string& bytes) {
  checkReplaceable(file);
  const std::string draft = file + ".part";
  ::unlink(draft.c_str());  // a link of that name would lead elsewhere
  bool written = false;
  {
    const Descriptor stream(::open(draft.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
    written = stream.isOpen() && stream.write(bytes) && stream.sync();
  }
  if (!written || std::rename(draft.c_str(), file.c_str()) != 0) {
    const std::string reason = std::strerror(errno);
    ::unlink(draft.c_str());
    throw InputError(fmt::format("{}: cannot be written: {}; check the folder and its disk", file, reason));
  }
  const Descriptor folder(::open(folderOf(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.isOpen()) folder.sync();  // else the name may be the old one after a power cut
}

}  // namespace blem_sim::sim
