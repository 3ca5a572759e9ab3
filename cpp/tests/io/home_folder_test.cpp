#include "snowshed/io/home_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace snowshed::io {
namespace {

class HomeFolder : public testing::Test {
 protected:
  HomeFolder() : home_(std::getenv("HOME") ? std::getenv("HOME") : "") {}
  ~HomeFolder() override { setenv("HOME", home_.c_str(), 1); }

 private:
  std::string home_;
};

TEST_F(HomeFolder, ReplacesALeadingTildeOnly) {
  setenv("HOME", "/users/ada", 1);
  EXPECT_EQ(with_home("~"), "/users/ada");
  EXPECT_EQ(with_home("~/post.stl"), "/users/ada/post.stl");
  for (const char* name : {"", "post.stl", "a/~/b", "post~", "~ada/post.stl", "/~"})
    EXPECT_EQ(with_home(name), name);
}

TEST_F(HomeFolder, NamesStayWithoutAHome) {
  unsetenv("HOME");
  EXPECT_EQ(with_home("~/post.stl"), "~/post.stl");
  setenv("HOME", "", 1);
  EXPECT_EQ(with_home("~/post.stl"), "~/post.stl");
}

}  // namespace
}  // namespace snowshed::io
