#!/usr/bin/env python3
"""Reads a trajectory and its exports with programs that know nothing of scree, and compares what they read.

    readers.py SCREE RUN      RUN is the folder of a run with a trajectory of `precision: double` and `contacts: true`

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
    names = rows[0] if rows else open(file).readline().strip().split(",")
    return {name: numpy.array([float(row[name]) for row in rows]) for name in names}


def vector(table, name, letters="xyz"):
    return numpy.stack([table[f"{name}_{letter}"] for letter in letters], axis=1)


def difference(a, b):
    a, b = numpy.asarray(a, float), numpy.asarray(b, float)
    return numpy.inf if a.shape != b.shape else float(numpy.abs(a - b).max(initial=0))


def compare_points(reader, data_of_frame, tables, rows_of_cell=1):
    """Points and all data of each frame, as VTK has them, with the tables; rows to a vertex, or to a line."""
    worst = {}
    for frame, table in enumerate(tables):
        data = data_of_frame(frame)
        if data.GetNumberOfPoints() == len(table["id"]) == 0:
            continue
        found = {"position": vtk_to_numpy(data.GetPoints().GetData())}
        for k in range(data.GetPointData().GetNumberOfArrays()):
            found[data.GetPointData().GetArrayName(k)] = vtk_to_numpy(data.GetPointData().GetArray(k))
        cells = data.GetVerts() if rows_of_cell == 1 else data.GetLines()
        joined = vtk_to_numpy(cells.GetConnectivityArray()) if cells.GetNumberOfCells() else []
        if cells.GetNumberOfCells() * rows_of_cell != len(table["id"]) or list(joined) != list(range(len(table["id"]))):
            failures.append(f"{reader}: frame {frame} has {cells.GetNumberOfCells()} cells, or joins others")
        for name, numbers in found.items():
            expected = table[name] if name in table else vector(table, name, "wxyz" if name == "orientation" else "xyz")
            worst[name] = max(worst.get(name, 0), difference(numbers, expected))
    for name, most in worst.items():
        report(reader, name, len(tables), most)


def read_vtkhdf(file, tables, rows_of_cell):
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(file))
    reader.UpdateInformation()
    if reader.GetNumberOfSteps() != len(tables):
        failures.append(f"VTKHDF: {reader.GetNumberOfSteps()} steps of {len(tables)}")

    def frame(k):
        reader.SetStep(k)
        reader.Update()
        return reader.GetOutputDataObject(0)

    compare_points("VTKHDF", frame, tables, rows_of_cell)


def read_vtp(folder, tables, rows_of_cell):
    def frame(k):
        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName(str(folder / f"{k:05}.vtp"))
        reader.Update()
        return reader.GetOutput()

    compare_points("vtp", frame, tables, rows_of_cell)


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
        read_vtkhdf(run / "trajectory.vtkhdf", tables, 1)
        read_vtp(folder / "vtp", tables, 1)
        read_xyz(folder, tables)
        contacts = [table_of(file) for file in sorted((folder / "contacts").glob("*.csv"))]
        print(f"contacts: {sum(len(table['id']) for table in contacts) // 2}")
        read_vtkhdf(run / "contacts.vtkhdf", contacts, 2)
        read_vtp(folder / "contacts", contacts, 2)
    for failure in failures:
        print("DIFFERENT:", failure)
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
