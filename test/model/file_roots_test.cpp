// Files are taken from below the folders that are allowed, wherever links lead.
#include "blem_sim/model/file_roots.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "blem_sim/geometry/input_error.h"
#include "blem_sim/model/loaders.h"
#include "support/temporary_folder.h"

namespace blem_sim::model {
namespace {

namespace fs = std::filesystem;

TEST(FileRoots, HoldFilesBelowThemAlone) {
  const TemporaryFolder temporary;
  const fs::path folder = temporary.path(), allowed = folder / "allowed";
  fs::create_directories(allowed / "deep");
  fs::create_directories(folder / "allowed_not");
  std::ofstream(folder / "secret.off") << "x";
  fs::create_symlink(folder / "secret.off", allowed / "link.off");
  fs::create_symlink(folder / "not_there_yet.bag", allowed / "nowhere.bag");
  fs::create_symlink("nowhere.bag", allowed / "first.bag");
  const FileRoots roots({allowed.string() + "/"});
  EXPECT_NO_THROW(roots.require((allowed / "deep" / "new.state").string()));
  for (const fs::path& path : {folder / "secret.off", allowed / ".." / "secret.off", allowed / "link.off", allowed / "nowhere.bag",
                               allowed / "first.bag", folder / "allowed_not" / "a.off"})
    EXPECT_THROW(roots.require(path.string()), InputError) << path;
  EXPECT_THROW(FileRoots(std::vector<std::string>{}).require((allowed / "a").string()), InputError);
  UriResolver resolver;
  resolver.restrictTo(roots);
  EXPECT_THROW(resolver.resolve((folder / "secret.off").string()), InputError);
}

}  // namespace
}  // namespace blem_sim::model
