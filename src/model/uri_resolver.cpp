#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include "blem_sim/model/loaders.h"

namespace blem_sim::model {
namespace {

namespace fs = std::filesystem;

/** Places that were looked at in vain, for the error text. */
using Tried = std::vector<std::string>;

bool startsWith(const std::string& text, const std::string& prefix) { return text.compare(0, prefix.size(), prefix) == 0; }

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/** Percent-encoded bytes decoded [RFC 3986, 2.1]; a stray % stays. */
std::string percentDecoded(const std::string& text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool encoded = text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0;
    decoded += encoded ? static_cast<char>(16 * hexDigit(text[i + 1]) + hexDigit(text[i + 2])) : text[i];
    if (encoded) i += 2;
  }
  return decoded;
}

std::vector<std::string> environmentPaths(const char* variable) {
  std::vector<std::string> paths;
  const char* value = std::getenv(variable);
  std::istringstream stream(value ? value : "");
  for (std::string path; std::getline(stream, path, ':');)
    if (!path.empty()) paths.push_back(path);
  return paths;
}

bool isFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

bool isDirectory(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

/** The <name> of a package.xml; empty if there is none. */
std::string packageXmlName(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  const std::string text = buffer.str();
  const std::size_t open = text.find("<name>");
  const std::size_t close = text.find("</name>", open == std::string::npos ? 0 : open);
  if (open == std::string::npos || close == std::string::npos) return "";
  const std::string name = text.substr(open + 6, close - open - 6);
  const std::size_t first = name.find_first_not_of(" \t\r\n");
  return first == std::string::npos ? "" : name.substr(first, name.find_last_not_of(" \t\r\n") - first + 1);
}

bool isPackageNamed(const fs::path& folder, const std::string& name) {
  if (!isFile(folder / "package.xml")) return false;
  return folder.filename() == name || packageXmlName(folder / "package.xml") == name;
}

/** Searches a tree as rospack does: a folder with a package.xml is a package and is not searched further; hidden and ignored folders are
 *  left out. */
std::string crawl(const fs::path& folder, const std::string& name, std::set<std::string>* visited) {
  std::error_code error;
  const fs::path canonical = fs::canonical(folder, error);
  if (error || !visited->insert(canonical.string()).second) return "";
  if (isPackageNamed(folder, name)) return folder.string();
  for (const char* mark : {"package.xml", "CATKIN_IGNORE", "rospack_nosubdirs"})
    if (fs::exists(folder / mark, error)) return "";
  std::set<fs::path> children;
  for (fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, error), end; !error && it != end;
       it.increment(error))
    if (isDirectory(it->path()) && it->path().filename().string().front() != '.') children.insert(it->path());
  for (const fs::path& child : children) {
    const std::string found = crawl(child, name, visited);
    if (!found.empty()) return found;
  }
  return "";
}

/** Folder of the package in one entry of ROS_PACKAGE_PATH. The usual layouts are asked first; a tree is searched last. */
std::string packageInEntry(const std::string& entry, const std::string& name) {
  const fs::path path = fs::path(entry + "/").parent_path();
  if (isPackageNamed(path, name)) return path.string();
  if (isPackageNamed(path / name, name)) return (path / name).string();
  std::set<std::string> visited;
  const std::string found = crawl(path, name, &visited);
  if (!found.empty()) return found;
  // A folder that bears the name but has no package.xml is taken rather than refused: plain data folders look like that.
  if (path.filename() == name && isDirectory(path)) return path.string();
  return isDirectory(path / name) ? (path / name).string() : "";
}

std::string packageFolder(const std::string& name, const std::map<std::string, std::string>& packages, Tried* tried) {
  const auto given = packages.find(name);
  if (given != packages.end()) return given->second;
  for (const std::string& entry : environmentPaths("ROS_PACKAGE_PATH")) {
    const std::string found = packageInEntry(entry, name);
    if (!found.empty()) return found;
    tried->push_back(entry + " (ROS_PACKAGE_PATH)");
  }
  std::vector<std::string> prefixes = environmentPaths("CMAKE_PREFIX_PATH");
  prefixes.push_back("/usr");
  for (const std::string& prefix : prefixes) {
    const fs::path share = fs::path(prefix) / "share" / name;
    if (isDirectory(share)) return share.string();
    tried->push_back(share.string());
  }
  return "";
}

/** The file, spelled as it is or percent-decoded; empty if neither exists. */
std::string existingFile(const fs::path& folder, const std::string& relative, Tried* tried) {
  for (const std::string& spelling : {relative, percentDecoded(relative)}) {
    const fs::path path = (folder / spelling).lexically_normal();
    if (isFile(path)) return path.string();
    if (tried->empty() || tried->back() != path.string()) tried->push_back(path.string());
  }
  return "";
}

std::string joined(const Tried& tried) { return fmt::format("{}", fmt::join(tried, ", ")); }

std::string resolvePackage(const std::string& uri, const std::map<std::string, std::string>& packages) {
  const std::string rest = uri.substr(std::string("package://").size());
  const std::size_t slash = rest.find('/');
  const std::string name = rest.substr(0, slash);
  if (name.empty() || slash == std::string::npos || slash + 1 == rest.size())
    throw InputError(fmt::format("'{}': a package URI is package://NAME/path/of/file", uri));
  Tried tried;
  const std::string folder = packageFolder(name, packages, &tried);
  if (folder.empty())
    throw InputError(
        fmt::format("'{}': package '{}' not found; tried: {}; name its folder (--package {}=DIR) or add it to ROS_PACKAGE_PATH", uri, name,
                    joined(tried), name));
  tried.clear();
  const std::string file = existingFile(folder, rest.substr(slash + 1), &tried);
  if (file.empty())
    throw InputError(fmt::format("'{}': no such file in package '{}'; tried: {}; check the path or name another folder for the package",
                                 uri, name, joined(tried)));
  return file;
}

}  // namespace

UriResolver::UriResolver(std::map<std::string, std::string> packages) : packages_(std::move(packages)) {}

std::string UriResolver::resolve(const std::string& uri, const std::string& base) const {
  std::string file = find(uri, base);
  if (roots_) roots_->require(file);
  return file;
}

std::string UriResolver::find(const std::string& uri, const std::string& base) const {
  if (uri.empty()) throw InputError("an empty file name; write package://NAME/path, file:///path or a path");
  if (startsWith(uri, "package://")) return resolvePackage(uri, packages_);
  std::string path = uri;
  if (startsWith(uri, "file://")) {
    path = uri.substr(std::string("file://").size());
    if (startsWith(path, "localhost/")) path = path.substr(std::string("localhost").size());
  } else if (uri.find("://") != std::string::npos) {
    throw InputError(fmt::format("'{}': unknown scheme; use package://NAME/path, file:///path or a path", uri));
  }
  Tried tried;
  std::error_code error;
  const fs::path folder = base.empty() ? fs::current_path(error) : fs::path(base);
  const std::string file = existingFile(folder, path, &tried);
  if (file.empty()) throw InputError(fmt::format("'{}': no such file; tried: {}; check the path", uri, joined(tried)));
  return file;
}

}  // namespace blem_sim::model
