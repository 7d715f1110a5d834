#include "saving/service_files.h"

#include "blem_sim/geometry/input_error.h"

namespace blem_sim::node {

std::string ServiceFiles::allowed(const std::string& file) const {
  if (file.empty()) throw InputError("file: is empty; give a path");
  const std::string path = file.front() == '/' || folder_.empty() ? file : folder_ + "/" + file;
  roots_.require(path);
  return path;
}

}  // namespace blem_sim::node
