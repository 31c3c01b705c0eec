// A library that makes calls fail on demand. It is loaded before a program's libraries (LD_PRELOAD), and
// environment variables, which faults.py sets, say which calls fail. FAULT is one of these:
// - write, fsync, rename: the call fails with FAULT_ERRNO if its path contains FAULT_PATH;
// - memory: once FAULT_AFTER bytes have been written to such a path, allocations of FAULT_SIZE bytes and more
// fail;
// - allocation: allocations of FAULT_SIZE bytes and more fail, whatever has been written; if FAULT_TIMES
// limits their number, allocations by HDF5 do not fail;
// - arrays: as for memory, but only aligned allocations fail, which only a program's own arrays use;
// - limit: once FAULT_AFTER bytes have been written to such a path, the process gets no more address space
// (RLIMIT_AS);
// - flush: flushing a stream to such a path fails, and its buffer is lost, as on a full disk;
// - osmesa_create, osmesa_current: the first call of OSMesa that can fail does so, or the second one;
// - realtime: the time of day is by turns right, FAULT_SIZE seconds ahead and FAULT_SIZE seconds behind;
// - monotonic: the steady clock is FAULT_SIZE seconds ahead.
// FAULT_AFTER is the number of bytes (for write, too) or of calls before the first fault. FAULT_TIMES is the
// number of faults; 0 means no limit. FAULT_NOTE is a file that gets one byte for each fault (for memory,
// arrays and limit: one in all, when the shortage begins).
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdio_ext.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static const char* fault = "";
static const char* path_part = "";
static int note = -1;
static int error_number = 0;
static long long after = 0, times = 0, size = 0;
static _Atomic long long passed = 0, caused = 0, refused = 0;
static atomic_bool short_of_memory = false;

static const char* text_of(const char* name, const char* otherwise) {
  const char* value = getenv(name);
  return value ? value : otherwise;
}

static long long number_of(const char* name) { return atoll(text_of(name, "0")); }

// Reads the variables, and unsets LD_PRELOAD so that no call fails in programs that this one starts (ffmpeg).
__attribute__((constructor)) static void begin(void) {
  path_part = text_of("FAULT_PATH", "");
  error_number = (int)number_of("FAULT_ERRNO");
  after = number_of("FAULT_AFTER");
  times = number_of("FAULT_TIMES");
  size = number_of("FAULT_SIZE");
  // The file gets a descriptor of 100 or more, a number that no file of the program would have.
  const int low = open(text_of("FAULT_NOTE", "/dev/null"), O_WRONLY | O_CREAT | O_APPEND, 0666);
  note = fcntl(low, F_DUPFD_CLOEXEC, 100);
  close(low);
  fault = text_of("FAULT", "");
  unsetenv("LD_PRELOAD");
}

static bool is(const char* name) { return strcmp(fault, name) == 0; }

static ssize_t real_write(int descriptor, const void* bytes, size_t count) {
  ssize_t (*next)(int, const void*, size_t) = NULL;
  *(void**)&next = dlsym(RTLD_NEXT, "write");
  return next(descriptor, bytes, count);
}

// Counts `amount` more bytes or calls, and returns whether the present call is to fail.
static bool is_due(long long amount) {
  if (atomic_fetch_add(&passed, amount) + amount <= after) return false;
  if (atomic_fetch_add(&caused, 1) >= times && times > 0) return false;
  real_write(note, "!", 1);
  return true;
}

static bool concerns(const char* path) { return strstr(path, path_part) != NULL; }

static bool concerns_file(int descriptor) {
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length < 0) return false;
  path[length] = '\0';
  return concerns(path);
}

static void limit_memory(void) {
  if (setrlimit(RLIMIT_AS, &(struct rlimit){0, RLIM_INFINITY}) != 0) abort();
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  const bool shortens = is("memory") || is("arrays") || is("limit");
  if ((!is("write") && !shortens) || !concerns_file(descriptor)) return real_write(descriptor, bytes, count);
  if (shortens) {
    if (!atomic_load(&short_of_memory) && is_due((long long)count)) {
      if (is("limit")) limit_memory();
      atomic_store(&short_of_memory, true);
    }
    return real_write(descriptor, bytes, count);
  }
  // As on a real disk, the bytes for which there is room are written, and the next call fails.
  const long long room = after - atomic_load(&passed);
  if (room > 0 && room < (long long)count) {
    atomic_fetch_add(&passed, room);
    return real_write(descriptor, bytes, (size_t)room);
  }
  if (!is_due((long long)count)) return real_write(descriptor, bytes, count);
  errno = error_number;
  return -1;
}

// HDF5 writes with this call.
ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t place) {
  if (is("write") && concerns_file(descriptor) && is_due((long long)count)) {
    errno = error_number;
    return -1;
  }
  ssize_t (*next)(int, const void*, size_t, off_t) = NULL;
  *(void**)&next = dlsym(RTLD_NEXT, "pwrite");
  return next(descriptor, bytes, count, place);
}

int fsync(int descriptor) {
  if (is("fsync") && concerns_file(descriptor) && is_due(1)) {
    errno = error_number;
    return -1;
  }
  int (*next)(int) = NULL;
  *(void**)&next = dlsym(RTLD_NEXT, "fsync");
  return next(descriptor);
}

int fflush(FILE* stream) {
  if (is("flush") && concerns_file(fileno(stream)) && is_due(1)) {
    __fpurge(stream);
    errno = error_number;
    return EOF;
  }
  int (*next)(FILE*) = NULL;
  *(void**)&next = dlsym(RTLD_NEXT, "fflush");
  return next(stream);
}

int rename(const char* from, const char* to) {
  if (is("rename") && concerns(to) && is_due(1)) {
    errno = error_number;
    return -1;
  }
  int (*next)(const char*, const char*) = NULL;
  *(void**)&next = dlsym(RTLD_NEXT, "rename");
  return next(from, to);
}

// The allocators have glibc's own names here, because dlsym itself allocates memory.
void* __libc_malloc(size_t bytes);
void* __libc_calloc(size_t count, size_t bytes);
void* __libc_realloc(void* old, size_t bytes);
void* __libc_memalign(size_t alignment, size_t bytes);

// After a failed malloc HDF5 1.10 collects its free lists and tries again. If it then gets its memory,
// H5FL_blk_malloc counts the block in a list that was just freed, which corrupts the heap.
static bool is_from_hdf5(const void* caller) {
  Dl_info origin;
  return dladdr(caller, &origin) != 0 && strstr(origin.dli_fname, "libhdf5") != NULL;
}

static bool is_refused(size_t bytes, bool aligned, const void* caller) {
  if (is("allocation")) {
    if (bytes < (size_t)size || (times > 0 && is_from_hdf5(caller)) || !is_due(1)) return false;
    errno = ENOMEM;
    return true;
  }
  if (!atomic_load(&short_of_memory) || bytes < (size_t)size) return false;
  if (!is("memory") && !(is("arrays") && aligned)) return false;
  if (atomic_fetch_add(&refused, 1) >= times && times > 0) return false;
  errno = ENOMEM;
  return true;
}

void* malloc(size_t bytes) { return is_refused(bytes, false, __builtin_return_address(0)) ? NULL : __libc_malloc(bytes); }

void* calloc(size_t count, size_t bytes) {
  return is_refused(count * bytes, false, __builtin_return_address(0)) ? NULL : __libc_calloc(count, bytes);
}

void* realloc(void* old, size_t bytes) {
  return is_refused(bytes, false, __builtin_return_address(0)) ? NULL : __libc_realloc(old, bytes);
}

void* aligned_alloc(size_t alignment, size_t bytes) {
  return is_refused(bytes, true, __builtin_return_address(0)) ? NULL : __libc_memalign(alignment, bytes);
}

void* OSMesaCreateContextAttribs(const int* attributes, void* shared) {
  if (is("osmesa_create") && is_due(1)) return NULL;
  void* (*next)(const int*, void*) = NULL;
  *(void**)&next = dlsym(RTLD_NEXT, "OSMesaCreateContextAttribs");
  return next(attributes, shared);
}

unsigned char OSMesaMakeCurrent(void* context, void* buffer, unsigned type, int width, int height) {
  if (is("osmesa_current") && is_due(1)) return 0;
  unsigned char (*next)(void*, void*, unsigned, int, int) = NULL;
  *(void**)&next = dlsym(RTLD_NEXT, "OSMesaMakeCurrent");
  return next(context, buffer, type, width, height);
}

// Returns the seconds to add to a clock.
static long long jump(clockid_t clock) {
  const bool steady = clock == CLOCK_MONOTONIC;
  if (!(steady && is("monotonic")) && !(clock == CLOCK_REALTIME && is("realtime"))) return 0;
  if (!is_due(1)) return 0;
  return steady ? size : (atomic_load(&caused) % 3 - 1) * size;
}

int clock_gettime(clockid_t clock, struct timespec* now) {
  int (*next)(clockid_t, struct timespec*) = NULL;
  *(void**)&next = dlsym(RTLD_NEXT, "clock_gettime");
  const int status = next(clock, now);
  if (status == 0) now->tv_sec += jump(clock);
  return status;
}

int gettimeofday(struct timeval* restrict now, void* restrict zone) {
  (void)zone;
  struct timespec precise;
  const int status = clock_gettime(CLOCK_REALTIME, &precise);
  now->tv_sec = precise.tv_sec;
  now->tv_usec = precise.tv_nsec / 1000;
  return status;
}

time_t time(time_t* now) {
  struct timespec precise;
  clock_gettime(CLOCK_REALTIME, &precise);
  if (now) *now = precise.tv_sec;
  return precise.tv_sec;
}
