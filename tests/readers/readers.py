#!/usr/bin/env python3
"""Reads a trajectory and its exports with programs that know nothing of scree, and compares what they read.

    readers.py SCREE RUN      RUN is the folder of a run with a trajectory of `precision: double`

VTK (9.3 or newer) reads trajectory.vtkhdf and the .vtp files, ASE the extended XYZ, and the tables of `scree export --to csv` are what they are held to. Neither comes
from Debian 12: `pip install vtk ase numpy`. Exit status 1 if a number differs.
"""
import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import ase.io
import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

failures = []


def report(reader, what, frames, worst):
    print(f"{reader:<10} {what:<28} {frames:>4} frames, largest difference {worst:g}")
    if worst != 0:
        failures.append(f"{reader}: {what}")


def table_of(file):
    with open(file) as stream:
        rows = list(csv.DictReader(stream))
    return {name: numpy.array([float(row[name]) for row in rows]) for name in rows[0]}


def vector(table, name, letters="xyz"):
    return numpy.stack([table[f"{name}_{letter}"] for letter in letters], axis=1)


def difference(a, b):
    a, b = numpy.asarray(a, float), numpy.asarray(b, float)
    return numpy.inf if a.shape != b.shape else float(numpy.abs(a - b).max(initial=0))


def compare_points(reader, data_of_frame, tables):
    """Points and all data of each frame, as VTK has them, with the tables."""
    worst = {}
    for frame, table in enumerate(tables):
        data = data_of_frame(frame)
        found = {"position": vtk_to_numpy(data.GetPoints().GetData())}
        for k in range(data.GetPointData().GetNumberOfArrays()):
            found[data.GetPointData().GetArrayName(k)] = vtk_to_numpy(data.GetPointData().GetArray(k))
        if data.GetNumberOfVerts() != data.GetNumberOfPoints():
            failures.append(f"{reader}: frame {frame} has {data.GetNumberOfVerts()} vertices")
        for name, numbers in found.items():
            expected = table[name] if name in table else vector(table, name, "wxyz" if name == "orientation" else "xyz")
            worst[name] = max(worst.get(name, 0), difference(numbers, expected))
    for name, most in worst.items():
        report(reader, name, len(tables), most)


def read_vtkhdf(run, tables):
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(run / "trajectory.vtkhdf"))
    reader.UpdateInformation()
    if reader.GetNumberOfSteps() != len(tables):
        failures.append(f"VTKHDF: {reader.GetNumberOfSteps()} steps of {len(tables)}")

    def frame(k):
        reader.SetStep(k)
        reader.Update()
        return reader.GetOutputDataObject(0)

    compare_points("VTKHDF", frame, tables)


def read_vtp(folder, tables):
    def frame(k):
        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName(str(folder / f"vtp/{k:05}.vtp"))
        reader.Update()
        return reader.GetOutput()

    compare_points("vtp", frame, tables)


def read_xyz(folder, tables):
    frames = ase.io.read(folder / "trajectory.xyz", index=":", format="extxyz")
    worst = {"position": 0, "id": 0, "velo": 0}
    for atoms, table in zip(frames, tables, strict=True):
        particles = table["shape"] < 2
        worst["position"] = max(worst["position"], difference(atoms.positions, vector(table, "position")[particles]))
        worst["id"] = max(worst["id"], difference(atoms.arrays["id"], table["id"][particles]))
        if "velocity_x" in table:
            worst["velo"] = max(worst["velo"], difference(atoms.arrays["velo"], vector(table, "velocity")[particles]))
    for name, most in worst.items():
        report("ASE, xyz", name, len(frames), most)


def main():
    scree, run = sys.argv[1], Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for word in ("csv", "vtp", "xyz"):
            subprocess.run([scree, "export", run, "--to", word, "-o", folder], check=True, stdout=subprocess.DEVNULL)
        tables = [table_of(file) for file in sorted((folder / "csv").iterdir())]
        print(f"VTK {vtk.vtkVersion().GetVTKVersion()}, ASE {ase.__version__}")
        read_vtkhdf(run, tables)
        read_vtp(folder, tables)
        read_xyz(folder, tables)
    for failure in failures:
        print("DIFFERENT:", failure)
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
