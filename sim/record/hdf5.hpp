// What scree takes of HDF5, with its errors as exceptions. The library is included here alone.
#pragma once

#include "core/archive.hpp"

#include <hdf5.h>

namespace scree::hdf5 {

/// An object of the library, which is released with it.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  /// Throws as check() if the library gave none.
  Handle(hid_t id, Close close, const char* what);
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: the library's functions take it so

 private:
  hid_t id_;
  Close close_;
};

/// Throws RunError if the library says that it failed, and std::bad_alloc if for want of memory.
void check(herr_t status, const char* what);

/// To be called first. The library's own messages would go to stderr; and at the program's end it would try
/// again to write what it could not, and crash. It keeps the memory of what it has closed for what it opens
/// next: it crashes where it gets none for the cache of a file.
void start();

/// Of one number, little-endian; of a record, its bytes.
Handle type_of(const FieldType& type);

}  // namespace scree::hdf5
