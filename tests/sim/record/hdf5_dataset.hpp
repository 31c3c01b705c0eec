// Files as HDF5 itself reads them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <hdf5.h>
#include <string>
#include <vector>

namespace scree {

/// Part of a dataset as HDF5 reads it.
inline std::vector<double> dataset(const std::filesystem::path& file, const std::string& name, hsize_t first,
                                   hsize_t count) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t data = H5Dopen2(opened, name.c_str(), H5P_DEFAULT);
  const hid_t space = H5Dget_space(data);
  hsize_t extent[2] = {0, 1};
  H5Sget_simple_extent_dims(space, extent, nullptr);
  const hsize_t start[2] = {first, 0}, size[2] = {count, extent[1]};
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, size, nullptr);
  const hid_t memory = H5Screate_simple(2, size, nullptr);
  std::vector<double> numbers(count * extent[1]);
  EXPECT_GE(H5Dread(data, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, numbers.data()), 0) << name;
  H5Sclose(memory);
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(opened);
  return numbers;
}

}  // namespace scree
