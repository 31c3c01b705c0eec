#!/usr/bin/env python3
"""Takes all free memory of the first GPU, prints how much that is, and keeps it until this program is killed."""
import ctypes
import signal

MIB = 1 << 20


def check(status):
    if status != 0:
        raise SystemExit(f"CUDA error {status}")


def main():
    cuda = ctypes.CDLL("libcuda.so.1")
    device, context = ctypes.c_int(), ctypes.c_void_p()
    check(cuda.cuInit(0))
    check(cuda.cuDeviceGet(ctypes.byref(device), 0))
    check(cuda.cuDevicePrimaryCtxRetain(ctypes.byref(context), device))
    check(cuda.cuCtxSetCurrent(context))
    taken, piece = 0, 1024 * MIB
    while piece >= MIB:
        address = ctypes.c_uint64()
        if cuda.cuMemAlloc_v2(ctypes.byref(address), ctypes.c_size_t(piece)) == 0:
            taken += piece
        else:
            piece //= 2
    print(f"another program takes {taken // MIB} MiB", flush=True)
    signal.pause()


if __name__ == "__main__":
    main()
