#include "python_config.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "run_setup.h"

namespace py = pybind11;

namespace blem_sim::python {

namespace {

const char SOURCE[] = "configuration";   // name of what is in no file, in messages
constexpr std::size_t MOST_LEVELS = 64;  // of lists and dictionaries in each other: a list may hold itself

std::string typeName(const py::handle& value) { return py::str(value.get_type().attr("__name__")); }

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw InputError(fmt::format("{}: {}{}{}", SOURCE, path, path.empty() ? "" : ": ", why));
}

std::string numberText(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  return fmt::format("{}", value);
}

YAML::Node nodeOf(const py::handle& value, const std::string& path, std::size_t level);

YAML::Node mapOf(const py::handle& value, const std::string& path, std::size_t level) {
  YAML::Node map(YAML::NodeType::Map);
  for (const auto& entry : py::reinterpret_borrow<py::dict>(value)) {
    if (!py::isinstance<py::str>(entry.first)) refuse(path, fmt::format("a key must be a text, not {}", typeName(entry.first)));
    const std::string key = py::cast<std::string>(entry.first);
    map.force_insert(key, nodeOf(entry.second, path.empty() ? key : path + "." + key, level + 1));
  }
  return map;
}

YAML::Node listOf(const py::handle& value, const std::string& path, std::size_t level) {
  YAML::Node list(YAML::NodeType::Sequence);
  std::size_t index = 0;
  for (const py::handle& item : py::reinterpret_borrow<py::sequence>(value))
    list.push_back(nodeOf(item, fmt::format("{}[{}]", path, index++), level + 1));
  return list;
}

YAML::Node nodeOf(const py::handle& value, const std::string& path, std::size_t level) {
  if (level > MOST_LEVELS) refuse(path, fmt::format("lies more than {} levels deep; does it hold itself?", MOST_LEVELS));
  if (value.is_none()) return YAML::Node(YAML::NodeType::Null);
  if (py::isinstance<py::dict>(value)) return mapOf(value, path, level);
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) return listOf(value, path, level);
  if (py::isinstance<py::bool_>(value)) return YAML::Node(py::cast<bool>(value));
  if (py::isinstance<py::str>(value)) return YAML::Node(py::cast<std::string>(value));
  if (py::isinstance<py::float_>(value)) return YAML::Node(numberText(py::cast<double>(value)));
  if (py::isinstance<py::int_>(value)) return YAML::Node(py::cast<std::string>(py::str(value)));
  // Arrays and numbers of numpy.
  if (py::hasattr(value, "tolist")) return nodeOf(value.attr("tolist")(), path, level + 1);
  if (py::hasattr(value, "__fspath__")) return YAML::Node(pathOf(value, path));
  refuse(path, fmt::format("must be a number, a text, a list or a dictionary, not {}", typeName(value)));
}

YAML::Node textNode(const std::string& text) {
  try {
    return sim::loadYaml(text);
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}: is not YAML: {}", SOURCE, error.mark.line + 1, error.msg));
  }
}

/** @return key.path, value as YAML */
std::vector<std::pair<std::string, std::string>> settingsOf(const py::object& settings) {
  std::vector<std::pair<std::string, std::string>> replaced;
  if (settings.is_none()) return replaced;
  if (!py::isinstance<py::dict>(settings)) refuse("settings", fmt::format("must be a dictionary, not {}", typeName(settings)));
  for (const auto& setting : mapOf(settings, "", 0)) {
    YAML::Emitter value;
    value << YAML::Flow << setting.second;
    replaced.emplace_back(setting.first.Scalar(), value.c_str());
  }
  return replaced;
}

bool isText(const std::string& config) { return config.find('\n') != std::string::npos || (!config.empty() && config[0] == '{'); }

}  // namespace

std::string pathOf(const py::handle& value, const std::string& name) {
  if (py::isinstance<py::str>(value)) return py::cast<std::string>(value);
  if (!py::hasattr(value, "__fspath__")) refuse(name, fmt::format("must be a path, not {}", typeName(value)));
  const py::object path = value.attr("__fspath__")();
  if (!py::isinstance<py::str>(path)) refuse(name, "must be a path of text, not of bytes");
  return py::cast<std::string>(path);
}

std::map<std::string, std::string> packagesOf(const py::object& packages) {
  std::map<std::string, std::string> folders;
  if (packages.is_none()) return folders;
  if (!py::isinstance<py::dict>(packages)) refuse("packages", fmt::format("must be a dictionary of folders, not {}", typeName(packages)));
  for (const auto& entry : py::reinterpret_borrow<py::dict>(packages)) {
    const std::string name = pathOf(entry.first, "packages");
    folders[name] = pathOf(entry.second, "packages." + name);
  }
  return folders;
}

sim::SimulationConfig configOf(const py::object& config, const ConfigPlaces& places) {
  ConfigDocument document;
  document.source = SOURCE;
  document.folder = std::filesystem::current_path().string();
  if (py::isinstance<py::dict>(config)) {
    document.root = mapOf(config, "", 0);
  } else if (py::isinstance<py::str>(config) && isText(py::cast<std::string>(config))) {
    document.root = textNode(py::cast<std::string>(config));
  } else if (py::isinstance<py::str>(config) || py::hasattr(config, "__fspath__")) {
    document = readDocument(pathOf(config, "config"));
  } else {
    refuse("", fmt::format("must be a path, a text of YAML or a dictionary, not {}", typeName(config)));
  }
  if (!places.folder.is_none()) document.folder = std::filesystem::absolute(pathOf(places.folder, "folder")).string();
  return configOf(document, settingsOf(places.settings));
}

}  // namespace blem_sim::python
