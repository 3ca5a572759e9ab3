#include "snowshed/io/pvd_series.hpp"

#include <limits>
#include <stdexcept>

#include "io/temporary_folder.hpp"
#include "snowshed/core/errors.hpp"

namespace snowshed::io {
namespace {

using PvdSeriesTest = TemporaryFolder;

TEST_F(PvdSeriesTest, IsCompleteAfterEveryAppend) {
  PvdSeries series(path("snow.pvd"));
  EXPECT_FALSE(std::filesystem::exists(path("snow.pvd")));
  series.append(0.0, "snow_0.vtp");
  EXPECT_EQ(PvdSeries::reopen(path("snow.pvd")).entries().size(), 1u);
  series.append(0.1, "snow_1.vtp");
  EXPECT_EQ(content(path("snow.pvd")),
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
            "  <Collection>\n"
            "    <DataSet timestep=\"0\" part=\"0\" file=\"snow_0.vtp\"/>\n"
            "    <DataSet timestep=\"0.1\" part=\"0\" file=\"snow_1.vtp\"/>\n"
            "  </Collection>\n"
            "</VTKFile>\n"
            "<!-- checksum 81dab004 -->\n");
  EXPECT_EQ(number_of_files(), 1u);
}

TEST_F(PvdSeriesTest, ReopensExactly) {
  PvdSeries series(path("snow.pvd"));
  const double times[] = {1e-300, 0.1 + 0.2, 1.0 / 3.0, 1e6 + 1e-9};
  for (const double time : times) series.append(time, "a & \"b\".vtp");
  const PvdSeries reopened = PvdSeries::reopen(path("snow.pvd"));
  ASSERT_EQ(reopened.entries().size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(reopened.entries()[i].time, times[i]);
  EXPECT_EQ(reopened.entries()[0].file, "a & \"b\".vtp");
}

TEST_F(PvdSeriesTest, ReopeningDropsLaterEntries) {
  PvdSeries series(path("snow.pvd"));
  for (const double time : {0.0, 0.1, 0.2, 0.3}) series.append(time, "s.vtp");
  PvdSeries resumed = PvdSeries::reopen(path("snow.pvd"), 0.2);
  EXPECT_EQ(resumed.entries().size(), 2u);
  resumed.append(0.2, "again.vtp");
  const PvdSeries reopened = PvdSeries::reopen(path("snow.pvd"));
  ASSERT_EQ(reopened.entries().size(), 3u);
  EXPECT_EQ(reopened.entries().back().file, "again.vtp");
}

TEST_F(PvdSeriesTest, AChangedFileIsRefused) {
  PvdSeries series(path("snow.pvd"));
  for (const double time : {0.0, 0.1, 0.2}) series.append(time, "s.vtp");
  const std::string intact = content(path("snow.pvd"));
  for (std::size_t at = 0; at < intact.size(); ++at) {
    std::string bytes = intact;
    bytes[at] = bytes[at] == '3' ? '4' : '3';
    std::ofstream(path("snow.pvd")) << bytes;
    // Without the word before the checksum, the file counts as an older one without a checksum.
    if (at < intact.find("<!--") || at >= intact.find("checksum ") + 9)
      EXPECT_THROW(PvdSeries::reopen(path("snow.pvd")), InputError) << at;
  }
}

TEST_F(PvdSeriesTest, AnAbsentFileIsAnEmptySeries) {
  EXPECT_TRUE(PvdSeries::reopen(path("absent.pvd"), 1.0).entries().empty());
}

TEST_F(PvdSeriesTest, EndlessFilesAreRefused) {
  std::filesystem::create_symlink("/dev/zero", path("snow.pvd"));
  EXPECT_THROW(PvdSeries::reopen(path("snow.pvd")), InputError);
}

TEST_F(PvdSeriesTest, RefusesTimesOutOfOrder) {
  PvdSeries series(path("snow.pvd"));
  series.append(1.0, "a.vtp");
  EXPECT_THROW(series.append(0.5, "b.vtp"), std::invalid_argument);
  EXPECT_THROW(series.append(std::numeric_limits<double>::quiet_NaN(), "b.vtp"),
               std::invalid_argument);
}

TEST_F(PvdSeriesTest, RefusesInvalidFiles) {
  const std::string head = "<VTKFile>\n";
  for (const std::string line :
       {"<DataSet file=\"a\"/>", "<DataSet timestep=\"1\"/>",
        "<DataSet timestep=\"x\" file=\"a\"/>", "<DataSet timestep=\"nan\" file=\"a\"/>",
        "<DataSet timestep=\"1\" file=\"a"}) {
    write_plainly(path("bad.pvd"), head + line + "\n</VTKFile>\n");
    const std::string message = message_of<InputError>([&] { PvdSeries::reopen(path("bad.pvd")); });
    EXPECT_NE(message.find("bad.pvd:2: "), std::string::npos) << line;
  }
  write_plainly(path("bad.pvd"), head);
  EXPECT_THROW(PvdSeries::reopen(path("bad.pvd")), InputError);
}

}  // namespace
}  // namespace snowshed::io
