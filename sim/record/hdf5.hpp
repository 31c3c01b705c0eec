// What scree takes of HDF5, with its errors as exceptions. The library is included here alone.
#pragma once

#include "core/archive.hpp"

#include <hdf5.h>
#include <mutex>

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

/// Whoever uses the library holds one of these from before its first handle until after its last; any other
/// thread waits. So one file is open at a time. The library crashes where it gets no memory for the cache of
/// a file; but it keeps the cache of the file that was closed last for the one that is opened next.
/// The first Session also turns off the library's own messages to stderr, and its attempt at the program's
/// end to write again what it could not, in which it crashes. Throws as check().
class Session {
 public:
  Session();

 private:
  std::lock_guard<std::mutex> lock_;
};

/// Of one number, little-endian; of a record, its bytes.
Handle type_of(const FieldType& type);

}  // namespace scree::hdf5
