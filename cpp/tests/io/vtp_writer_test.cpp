#include "snowshed/io/vtp_writer.hpp"

#include <cstring>
#include <stdexcept>

#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::io {
namespace {

using VtpWriterTest = TemporaryFolder;
using Points = std::vector<std::array<float, 3>>;

std::string attribute(const std::string& element, const std::string& name) {
  const std::size_t start = element.find(" " + name + "=\"") + name.size() + 3;
  return element.substr(start, element.find('"', start) - start);
}

/// Returns a block as VTK reads it: at the offset that the element with this name gives.
template <class T>
std::vector<T> block(const std::string& file, const std::string& name) {
  const std::size_t name_at = file.find("Name=\"" + name + "\"");
  const std::size_t start = file.rfind('<', name_at);
  const std::string element = file.substr(start, file.find('>', start) - start);
  const std::string marker = "encoding=\"raw\">\n_";
  const std::size_t data =
      file.find(marker) + marker.size() + std::stoul(attribute(element, "offset"));
  std::uint64_t bytes;
  std::memcpy(&bytes, &file[data], sizeof bytes);
  std::vector<T> values(bytes / sizeof(T));
  if (bytes > 0) std::memcpy(values.data(), &file[data + sizeof bytes], bytes);
  return values;
}

TEST_F(VtpWriterTest, HoldsPointsArraysAndVertices) {
  const Points points = {{1, 2, 3}, {4, 5, 6}};
  write_vtp(path("a.vtp"), points,
            {{"velocity", 3, std::vector<float>{1, 0, 0, 0, 1, 0}},
             {"event", 1, std::vector<std::int32_t>{1, 2}},
             {"body", 1, std::vector<std::uint16_t>{7, 8}}});
  const std::string file = content(path("a.vtp"));
  EXPECT_NE(file.find("NumberOfPoints=\"2\" NumberOfVerts=\"2\""), std::string::npos);
  EXPECT_NE(file.find("type=\"UInt16\" Name=\"body\" NumberOfComponents=\"1\""), std::string::npos);
  EXPECT_EQ(block<float>(file, "position"), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(block<float>(file, "velocity"), (std::vector<float>{1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(block<std::int32_t>(file, "event"), (std::vector<std::int32_t>{1, 2}));
  EXPECT_EQ(block<std::uint16_t>(file, "body"), (std::vector<std::uint16_t>{7, 8}));
  EXPECT_EQ(block<std::int32_t>(file, "connectivity"), (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(block<std::int32_t>(file, "offsets"), (std::vector<std::int32_t>{1, 2}));
}

TEST_F(VtpWriterTest, KeepsDoublePositions) {
  write_vtp(path("a.vtp"), std::vector<std::array<double, 3>>{{0.1, 0.2, 0.3}}, {});
  const std::string file = content(path("a.vtp"));
  EXPECT_EQ(block<double>(file, "position"), (std::vector<double>{0.1, 0.2, 0.3}));
}

TEST_F(VtpWriterTest, WritesFilesWithoutPoints) {
  write_vtp(path("a.vtp"), Points{}, {{"event", 1, std::vector<std::int32_t>{}}});
  EXPECT_TRUE(block<float>(content(path("a.vtp")), "position").empty());
}

TEST_F(VtpWriterTest, EscapesNames) {
  write_vtp(path("a.vtp"), Points{}, {{"p < \"q\" & r", 1, std::vector<float>{}}});
  EXPECT_NE(content(path("a.vtp")).find("Name=\"p &lt; &quot;q&quot; &amp; r\""),
            std::string::npos);
}

TEST_F(VtpWriterTest, RefusesArraysOfWrongLength) {
  const Points points(2);
  for (const int components : {-1, 0, 2})
    EXPECT_THROW(write_vtp(path("a.vtp"), points, {{"v", components, std::vector<float>(3)}}),
                 std::invalid_argument);
  EXPECT_EQ(number_of_files(), 0u);
}

TEST_F(VtpWriterTest, AMissingFolderIsAFileError) {
  EXPECT_THROW(write_vtp(path("missing") / "a.vtp", Points{}, {}), FileError);
}

}  // namespace
}  // namespace snowshed::io
