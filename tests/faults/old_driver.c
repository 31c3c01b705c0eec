// libcuda.so.1 of a driver that is too old: it has CUDA 12.0, and nothing else.
int cuDriverGetVersion(int* version) {
  *version = 12000;
  return 0;
}
