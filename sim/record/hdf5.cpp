#include "sim/record/hdf5.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <mutex>
#include <new>

namespace scree::hdf5 {

namespace {

/// Throws std::bad_alloc if the library ran out of memory, else RunError.
[[noreturn]] void fail(const char* what) {
  bool lacks_memory = false;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* error, void* lacks) -> herr_t {
        const bool of_memory = error->maj_num == H5E_RESOURCE &&
                               (error->min_num == H5E_NOSPACE || error->min_num == H5E_CANTALLOC);
        if (of_memory) *static_cast<bool*>(lacks) = true;
        return 0;
      },
      &lacks_memory);
  if (lacks_memory) throw std::bad_alloc();
  throw RunError(fmt::format("HDF5 cannot {}", what));
}

/// The mutex that a Session holds.
std::mutex of_all_threads;

}  // namespace

Handle::Handle(hid_t id, Close close, const char* what) : id_(id), close_(close) {
  if (id < 0) fail(what);
}

void check(herr_t status, const char* what) {
  if (status < 0) fail(what);
}

Session::Session() : lock_(of_all_threads) {
  static const herr_t told = H5dont_atexit();
  check(told, "start");
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  constexpr int all = -1;
  check(H5set_free_list_limits(all, all, all, all, all, all), "start");
}

Handle type_of(const FieldType& type) {
  using Kind = FieldType::Kind;
  if (type.kind == Kind::bytes)
    return {H5Tcreate(H5T_OPAQUE, static_cast<std::size_t>(type.columns)), H5Tclose, "make a type"};
  const hid_t real = type.width == 4 ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
  const hid_t whole = type.kind == Kind::integer ? H5T_STD_I8LE : H5T_STD_U8LE;
  const hid_t id = H5Tcopy(type.kind == Kind::real ? real : whole);
  if (type.kind != Kind::real) {
    const auto bytes = static_cast<std::size_t>(type.width);
    check(H5Tset_size(id, bytes), "make a type");
    check(H5Tset_precision(id, 8 * bytes), "make a type");  // else all but 8 bits would be padding
  }
  return {id, H5Tclose, "make a type"};
}

}  // namespace scree::hdf5
