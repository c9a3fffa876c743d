// HDF5 files that this program did not write, or that were damaged since.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>

#include "core/error.h"
#include "testbed/formats/hdf5/content.h"
#include "tests/support/long_tests.h"
#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class ForeignHdf5 : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path file() const { return folder_.path / "foreign.h5"; }
  [[nodiscard]] fs::path folder() const { return folder_.path; }

  /// A file that `fill` wrote by HDF5 itself.
  void write(const std::function<void(hid_t)>& fill) const {
    const hid_t id = H5Fcreate(file().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    fill(id);
    H5Fclose(id);
  }
  [[nodiscard]] std::string read_error() const {
    return test::error_of([&] { (void)read_hdf5(file()); });
  }

 private:
  TestFolder folder_;
};

/// A data set of `extent` values of a type, laid out as `layout` says.
void add_data(hid_t parent, const char* name, hid_t type, hsize_t extent, hid_t layout) {
  const hid_t space = H5Screate_simple(1, &extent, nullptr);
  const hid_t data = H5Dcreate2(parent, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT);
  ASSERT_GE(data, 0);
  H5Dclose(data);
  H5Sclose(space);
}

TEST_F(ForeignHdf5, ValuesInAnotherFileAreRefused) {
  const fs::path secret = folder() / "secret";
  std::ofstream(secret) << "twelve bytes";
  write([&](hid_t root) {
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(layout, secret.c_str(), 0, 8);
    add_data(root, "stolen", H5T_IEEE_F64LE, 1, layout);
    H5Pclose(layout);
  });
  EXPECT_THAT(read_error(), HasSubstr(file().string() + ": /stolen: has its values in another"));
}

TEST_F(ForeignHdf5, VirtualDataSetsAreRefused) {
  write([&](hid_t root) {
    const hsize_t one = 1;
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(1, &one, nullptr);
    H5Pset_virtual(layout, space, "other.h5", "/x", space);
    add_data(root, "view", H5T_IEEE_F64LE, 1, layout);
    H5Sclose(space);
    H5Pclose(layout);
  });
  EXPECT_THAT(read_error(), HasSubstr("/view: has its values in another file"));
}

TEST_F(ForeignHdf5, LinksToOtherPlacesAreRefused) {
  write([](hid_t root) { H5Lcreate_external("/etc/x.h5", "/", root, "out", 0, 0); });
  EXPECT_THAT(read_error(), HasSubstr("/out: is a link to another place"));
  write([](hid_t root) { H5Lcreate_soft("/a", root, "soft", 0, 0); });
  EXPECT_THAT(read_error(), HasSubstr("/soft: is a link to another place"));
}

TEST_F(ForeignHdf5, AGroupInsideItselfIsRefused) {
  write([](hid_t root) {
    const hid_t group = H5Gcreate2(root, "loop", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_hard(root, "loop", group, "again", H5P_DEFAULT, H5P_DEFAULT);
    H5Gclose(group);
  });
  EXPECT_THAT(read_error(), HasSubstr("/loop: has several names"));
}

TEST_F(ForeignHdf5, GroupsOfAThousandLevelsAreRefused) {
  write([](hid_t root) {
    std::string name;
    for (int i = 0; i < 1000; ++i) name += "/g";
    const hid_t make = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(make, 1);
    H5Gclose(H5Gcreate2(root, name.c_str(), make, H5P_DEFAULT, H5P_DEFAULT));
    H5Pclose(make);
  });
  EXPECT_THAT(read_error(), HasSubstr("has groups more than 16 deep"));
}

TEST_F(ForeignHdf5, OtherFiltersAreRefused) {
  write([](hid_t root) {
    const hsize_t chunk = 8;
    const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(layout, 1, &chunk);
    H5Pset_fletcher32(layout);
    add_data(root, "packed", H5T_IEEE_F64LE, 8, layout);
    H5Pclose(layout);
  });
  EXPECT_THAT(read_error(), HasSubstr("/packed: is packed by the filter"));
}

TEST_F(ForeignHdf5, ExtentsBeyondTheFileAreRefusedBeforeTheyAreRead) {
  for (const hsize_t extent : {hsize_t{1} << 28, hsize_t{1} << 40, hsize_t{1} << 62}) {
    write([&](hid_t root) {
      const hsize_t chunk = 8;
      const hid_t layout = H5Pcreate(H5P_DATASET_CREATE);
      H5Pset_chunk(layout, 1, &chunk);
      add_data(root, "huge", H5T_STD_I32LE, extent, layout);
      H5Pclose(layout);
    });
    EXPECT_THAT(read_error(), HasSubstr("/huge: says to be larger than what the file can hold"));
  }
}

TEST_F(ForeignHdf5, OtherTypesAreRefused) {
  write([](hid_t root) { add_data(root, "text", H5T_C_S1, 0, H5P_DEFAULT); });
  EXPECT_THAT(read_error(), HasSubstr("/text: is neither numbers nor a table"));
  write([](hid_t root) { add_data(root, "small", H5T_STD_I16LE, 0, H5P_DEFAULT); });
  EXPECT_THAT(read_error(), HasSubstr("/small: holds numbers of 2 bytes"));
}

/// A flipped bit anywhere is an error that names the file, or changes a value; never a signal.
TEST_F(ForeignHdf5, LongFlippedBitsOfARunFileNeverEndTheProgram) {
  make_fake_run(folder());
  const std::string whole = read_whole_file(folder() / "run.h5");
  std::mt19937_64 random(1);
  int refused = 0;
  const int files = test::at_length() ? 1000 : 40;
  for (int i = 0; i < files; ++i) {
    std::string bytes = whole;
    for (int flips = 1 + i % 3; flips > 0; --flips) {
      char& byte = bytes[random() % bytes.size()];
      byte = static_cast<char>(byte ^ (1 << random() % 8));
    }
    write_file_atomically(file(), std::string_view(bytes));
    try {
      (void)read_run_file(file());
    } catch (const Error& error) {
      ++refused;
      EXPECT_THAT(error.what(), HasSubstr(file().string())) << i;
    }
  }
  EXPECT_GT(refused, files / 15);
}

}  // namespace
}  // namespace geoprior
