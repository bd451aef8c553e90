#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/unfinished_file.h"

namespace collarmesh::io {

/// Returns HDF5's identifier for a C++ type of numbers.
template <class Number>
hid_t native_type() {
  if constexpr (std::is_same_v<Number, char>) {
    return H5T_NATIVE_CHAR;
  } else if constexpr (std::is_same_v<Number, std::uint8_t>) {
    return H5T_NATIVE_UINT8;
  } else if constexpr (std::is_same_v<Number, std::int32_t>) {
    return H5T_NATIVE_INT32;
  } else if constexpr (std::is_same_v<Number, std::int64_t>) {
    return H5T_NATIVE_INT64;
  } else if constexpr (std::is_same_v<Number, float>) {
    return H5T_NATIVE_FLOAT;
  } else {
    static_assert(std::is_same_v<Number, double>);
    return H5T_NATIVE_DOUBLE;
  }
}

/// An owner of an HDF5 object, which it closes.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// An HDF5 file that appears under its name when it is complete, or not at all.
class Hdf5File {
 public:
  explicit Hdf5File(std::string path, hid_t properties = H5P_DEFAULT) : target_(std::move(path)) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // we report errors ourselves
    file_ = H5Fcreate(target_.temporary().c_str(), H5F_ACC_TRUNC, properties, H5P_DEFAULT);
    require(file_ >= 0);
  }
  ~Hdf5File() {
    if (file_ >= 0) H5Fclose(file_);
  }
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Writes values as a data set of this size.
  template <class Number>
  void write(const std::string& name, const Number* values, const std::vector<hsize_t>& size) const {
    const hid_t type = native_type<Number>();
    const Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
    const Handle set(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                     H5Dclose);
    require(set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  }

  void commit() {
    require(H5Fclose(std::exchange(file_, -1)) >= 0);
    target_.commit();
  }

  /// Throws WriteError if `done` is false.
  void require(bool done) const {
    if (!done) target_.fail(0);
  }
  hid_t id() const { return file_; }

 private:
  UnfinishedFile target_;
  hid_t file_ = -1;
};

}  // namespace collarmesh::io
