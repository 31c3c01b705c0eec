// The parts of HDF5 that scree uses, with errors as exceptions; the library is included only here.
#pragma once

#include "core/archive.hpp"

#include <hdf5.h>
#include <mutex>

namespace scree::hdf5 {

/// An object of the library, which is released with the handle.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  /// Throws the errors of check() if the library gave no object.
  Handle(hid_t id, Close close, const char* what);
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: the library's functions take it so

 private:
  hid_t id_;
  Close close_;
};

/// Throws RunError if the status says that the library has failed, and std::bad_alloc if it ran out of
/// memory.
void check(herr_t status, const char* what);

/// The right to use the library, for one thread at a time: hold one from before the first handle until after
/// the last one; other threads wait. So only one file is open at a time. The library crashes if it gets no
/// memory for the cache of a file, but it keeps the cache of the file that was closed last for the next one.
/// The first Session also turns off the library's own messages to stderr, and its attempt at the end of the
/// program to write again what it could not write, in which it crashes. Throws the errors of check().
class Session {
 public:
  Session();

 private:
  std::lock_guard<std::mutex> lock_;
};

/// Returns the type of a number, little-endian, or of the bytes of a record.
Handle type_of(const FieldType& type);

}  // namespace scree::hdf5
