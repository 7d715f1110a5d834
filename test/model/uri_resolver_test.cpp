#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>

#include "blem_sim/model/loaders.h"
#include "support/input_errors.h"
#include "support/temporary_folder.h"

namespace blem_sim::model {
namespace {

/** Sets an environment variable for one test. */
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~Environment() { old_ ? setenv(name_, old_->c_str(), 1) : unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

std::string packageXml(const std::string& name) { return "<package>\n  <name> " + name + "\n</name></package>"; }

class UriResolverTest : public testing::Test {
 protected:
  TemporaryFolder folder_;
  Environment packages_{"ROS_PACKAGE_PATH", ""};
  Environment prefixes_{"CMAKE_PREFIX_PATH", ""};
};

TEST_F(UriResolverTest, explicitPackagesComeFirst) {
  const std::string mine = folder_.write("mine/robot/a.stl", "x");
  folder_.write("path/robot/a.stl", "x");
  folder_.write("path/robot/package.xml", packageXml("robot"));
  const Environment path("ROS_PACKAGE_PATH", folder_.path("path"));
  EXPECT_EQ(UriResolver({{"robot", folder_.path("mine/robot")}}).resolve("package://robot/a.stl"), mine);
}

TEST_F(UriResolverTest, rosPackagePathHoldsPackagesOrTrees) {
  const std::string itself = folder_.write("itself/m/a.stl", "x");
  folder_.write("itself/package.xml", packageXml("other_name"));
  const std::string deep = folder_.write("tree/stack/deep/b.stl", "x");
  folder_.write("tree/stack/deep/package.xml", packageXml("deep"));
  folder_.write("tree/ignored/CATKIN_IGNORE", "");
  folder_.write("tree/ignored/hidden_robot/package.xml", packageXml("hidden_robot"));
  folder_.write("tree/ignored/hidden_robot/c.stl", "x");
  const Environment path("ROS_PACKAGE_PATH", folder_.path("itself") + ":" + folder_.path("missing") + "::" + folder_.path("tree"));
  EXPECT_EQ(UriResolver().resolve("package://other_name/m/a.stl"), itself);
  EXPECT_EQ(UriResolver().resolve("package://deep/b.stl"), deep);
  EXPECT_TRUE(isOneLineWith(refusal([] { UriResolver().resolve("package://hidden_robot/c.stl"); }), {"hidden_robot", "ROS_PACKAGE_PATH"}));
}

TEST_F(UriResolverTest, aLoopOfLinksEnds) {
  std::filesystem::create_directories(folder_.path("tree/a"));
  std::filesystem::create_directory_symlink(folder_.path("tree"), folder_.path("tree/a/back"));
  const Environment path("ROS_PACKAGE_PATH", folder_.path("tree"));
  EXPECT_NE(refusal([] { UriResolver().resolve("package://nowhere/a.stl"); }), "");
}

TEST_F(UriResolverTest, installedPackagesLieBelowShare) {
  const std::string file = folder_.write("install/share/robot/a.stl", "x");
  const Environment prefix("CMAKE_PREFIX_PATH", folder_.path("install"));
  EXPECT_EQ(UriResolver().resolve("package://robot/a.stl"), file);
}

TEST_F(UriResolverTest, filesWithSpacesAndPercents) {
  const std::string file = folder_.write("a folder/50%/m\xC3\xBCg.stl", "x");
  const UriResolver resolver({{"robot", folder_.path()}});
  EXPECT_EQ(resolver.resolve(file), file);
  EXPECT_EQ(resolver.resolve("file://" + file), file);
  EXPECT_EQ(resolver.resolve("file://localhost" + folder_.path() + "/a%20folder/50%25/m%c3%BCg.stl"), file);
  EXPECT_EQ(resolver.resolve("package://robot/a%20folder/50%/m\xC3\xBCg.stl"), file);
}

TEST_F(UriResolverTest, relativeToABase) {
  const std::string file = folder_.write("meshes/a.stl", "x");
  EXPECT_EQ(UriResolver().resolve("meshes/a.stl", folder_.path()), file);
  EXPECT_EQ(UriResolver().resolve("../meshes/a.stl", folder_.path("meshes")), file);
}

TEST_F(UriResolverTest, refusalsNameEveryPlaceAndTheCure) {
  const Environment path("ROS_PACKAGE_PATH", folder_.path("one") + ":" + folder_.path("two"));
  const Environment prefix("CMAKE_PREFIX_PATH", folder_.path("three"));
  EXPECT_TRUE(isOneLineWith(refusal([] { UriResolver().resolve("package://robot/a.stl"); }),
                            {"package://robot/a.stl", folder_.path("one"), folder_.path("two"), folder_.path("three") + "/share/robot",
                             "/usr/share/robot", "--package robot=DIR"}));
  const UriResolver known({{"robot", folder_.path()}});
  EXPECT_TRUE(isOneLineWith(refusal([&] { known.resolve("package://robot/a.stl"); }), {folder_.path("a.stl"), "check"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { known.resolve("a.stl", folder_.path()); }), {folder_.path("a.stl")}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { known.resolve("http://host/a.stl"); }), {"scheme", "package://"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { known.resolve("package://robot"); }), {"package://NAME/path"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { known.resolve(""); }), {"empty"}));
  EXPECT_TRUE(isOneLineWith(refusal([&] { known.resolve(folder_.path()); }), {"no such file"}));  // a folder is no file
}

}  // namespace
}  // namespace blem_sim::model
