// A libcuda.so.1 of a driver that is too old: it reports CUDA 12.0, and has no other function.
int cuDriverGetVersion(int* version) {
  *version = 12000;
  return 0;
}
