#!/usr/bin/env python3
"""Reads a trajectory and its exports with programs that know nothing of scree, and compares what they read.

    readers.py SCREE RUN      RUN is the folder of a run with a trajectory of `precision: double` and `contacts: true`

VTK (9.3 or newer) reads trajectory.vtkhdf and the .vtp files; ASE reads the extended XYZ and the dump of LAMMPS. What they read is compared with the tables of
`scree export --to csv`. Debian 12 has neither program: `pip install vtk ase numpy`. If OVITO is installed (`pip install ovito`), it also reads the XYZ file and the
dump, with the shapes of the particles. The exit status is 1 if a number differs; numbers that are computed may differ by rounding.
"""
import csv
import subprocess
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import ase.io
import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

try:
    from ovito.io import import_file
except ImportError:
    import_file = None

# The particle type in XYZ files and dumps of each of scree's shapes, in their order; 0 if bodies of the shape are no particles.
KIND = numpy.array([1, 2, 0, 0, 0, 3, 4, 5])
TUBE, TRIANGLE, CAPSULE, CYLINDER, POLYHEDRON = 3, 4, 5, 6, 7
ROUNDING = 1e-12  # tolerance of positions that are computed (m)
SINGLE = 1e-6  # tolerance of values that OVITO keeps in single precision

failures = []


def report(reader, what, frames, worst, allowed=0):
    print(f"{reader:<10} {what:<28} {frames:>4} frames, largest difference {worst:g}")
    if not worst <= allowed:
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
    """Compares points and all their data, as VTK has them, with the tables, frame by frame. A cell has one row of the table (a vertex) or two (a line)."""
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


def outlines(table):
    """Returns radii and aspherical shapes (OVITO's term) of the particles of a frame, one for each row of the table."""
    size, shape = vector(table, "size"), table["shape"]
    radius = numpy.where(numpy.isin(shape, (0, CAPSULE, CYLINDER)), size[:, 0] / 2, 0)
    outline = size / 2
    outline[shape == 0] = 0
    outline[shape == CAPSULE, 2] = (size[:, 2] - size[:, 0])[shape == CAPSULE]
    outline[shape == CYLINDER, 2] = size[shape == CYLINDER, 2]
    return radius, outline


def expected_particles(table):
    kinds = KIND[table["shape"].astype(int)]
    rows = kinds > 0
    radius, outline = outlines(table)
    expected = {"position": vector(table, "position"), "id": table["id"], "type": kinds, "radius": radius, "aspherical_shape": outline}
    if "velocity_x" in table:
        expected["velo"] = vector(table, "velocity")
    if "orientation_w" in table:
        expected["orientation"] = vector(table, "orientation", "xyzw")
    return {name: numbers[rows] for name, numbers in expected.items()}


def read_xyz(folder, tables):
    frames = ase.io.read(folder / "trajectory.xyz", index=":", format="extxyz")
    worst = {}
    for atoms, table in zip(frames, tables, strict=True):
        for name, expected in expected_particles(table).items():
            found = atoms.positions if name == "position" else atoms.arrays[name]
            worst[name] = max(worst.get(name, 0), difference(found, expected))
    for name, most in worst.items():
        report("ASE, xyz", name, len(frames), most, ROUNDING if name == "aspherical_shape" else 0)


def read_dump(folder, tables):
    """Compares what ASE reads of the dump (positions and types), sorted by particle number."""
    frames = ase.io.read(folder / "trajectory.lammpstrj", index=":", format="lammps-dump-text")
    worst = {"position": 0, "type": 0}
    for atoms, table in zip(frames, tables, strict=True):
        expected = expected_particles(table)
        order = numpy.argsort(expected["id"])
        worst["position"] = max(worst["position"], difference(atoms.positions, expected["position"][order]))
        worst["type"] = max(worst["type"], difference(atoms.arrays["type"], expected["type"][order]))
    for name, most in worst.items():
        report("ASE, dump", name, len(frames), most)


def read_with_ovito(file, tables):
    """Compares what OVITO reads. In a dump, particle numbers begin at 1, and spheres have an aspherical shape."""
    names = {"position": "Position", "id": "Particle Identifier", "type": "Particle Type", "aspherical_shape": "Aspherical Shape", "velo": "Velocity",
             "orientation": "Orientation", "radius": "Radius"}
    is_dump = file.suffix == ".lammpstrj"
    pipeline, worst = import_file(str(file)), {}
    if pipeline.num_frames != len(tables):
        failures.append(f"OVITO: {pipeline.num_frames} frames of {len(tables)}")
    for frame, table in enumerate(tables):
        particles = pipeline.compute(frame).particles
        expected = expected_particles(table)
        if is_dump:
            expected["id"] = expected["id"] + 1
            spheres = expected["type"] == 1
            expected["aspherical_shape"][spheres] = expected["radius"][spheres, None]
        for name, numbers in expected.items():
            worst[name] = max(worst.get(name, 0), difference(particles[names[name]][...], numbers))
    for name, most in worst.items():
        allowed = {"id": 0, "type": 0, "position": ROUNDING}.get(name, SINGLE)  # OVITO rounds the numbers that it reads
        report("OVITO", f"{file.suffix} {name}", len(tables), most, allowed)


def turned(table, rows, local):
    """Returns points that are given in the frames of bodies (rows x points x 3) in the frame of the world."""
    w, u = vector(table, "orientation", "w")[rows][:, None], vector(table, "orientation")[rows][:, None]
    twice = 2 * numpy.cross(u, local)
    return vector(table, "position")[rows][:, None] + local + w * twice + numpy.cross(u, twice)


def corners_of(table, rows):
    """Returns the corners of triangles."""
    a, b, c = (vector(table, "size")[rows] / 2).T
    zero = numpy.zeros_like(a)
    return turned(table, rows, numpy.stack([numpy.stack(x, 1) for x in ((-a, -c, zero), (a, -c, zero), (b, c, zero))], 1))


def read_collection(file):
    """Returns the parts of each frame."""
    frames = {}
    for entry in ElementTree.parse(file).getroot().iter("DataSet"):
        reader = vtk.vtkXMLPolyDataReader()
        reader.SetFileName(str(file.parent / entry.get("file")))
        reader.Update()
        frames.setdefault(entry.get("timestep"), []).append(reader.GetOutput())
    return list(frames.values())


def cells_of(part, cells):
    """Returns the positions of the corners of each cell."""
    if part.GetNumberOfPoints() == 0:
        return []
    x = vtk_to_numpy(part.GetPoints().GetData())
    ends, joined = vtk_to_numpy(cells.GetOffsetsArray()), vtk_to_numpy(cells.GetConnectivityArray())
    return [x[joined[ends[k]:ends[k + 1]]] for k in range(len(ends) - 1)]


def read_surfaces(file, tables):
    """Checks that triangles have the corners that their rows say, and that polyhedra are closed, face outward and have the size of their rows."""
    worst = {"triangles": 0.0, "polyhedra": 0.0}
    for parts, table in zip(read_collection(file), tables, strict=True):
        row_of = {int(number): row for row, number in enumerate(table["id"])}
        found, hulls = {}, {}
        for part in parts:
            ids = part.GetCellData().GetArray("id")
            for k, corners in enumerate(cells_of(part, part.GetPolys())):
                row = row_of[int(ids.GetValue(k))]
                (found.setdefault(row, corners) if table["shape"][row] == TRIANGLE else hulls.setdefault(row, []).append(corners))
        triangles = numpy.flatnonzero(table["shape"] == TRIANGLE)
        if set(found) != set(triangles) or set(hulls) != set(numpy.flatnonzero(table["shape"] == POLYHEDRON)):
            failures.append(f"surfaces: of other bodies than the table's, {len(found)} triangles and {len(hulls)} polyhedra")
            continue
        if len(triangles):
            worst["triangles"] = max(worst["triangles"], difference([found[row] for row in triangles], corners_of(table, triangles)))
        for row, faces in hulls.items():
            middle = vector(table, "position")[row]
            away = numpy.concatenate(faces) - middle
            w, u = table["orientation_w"][row], -vector(table, "orientation")[row]
            local = away + w * 2 * numpy.cross(u, away) + 2 * numpy.cross(u, numpy.cross(u, away))
            fans = [(face[[0, k, k + 1]] - middle) for face in faces for k in range(1, len(face) - 1)]
            volume = sum(numpy.linalg.det(fan) for fan in fans) / 6
            if not 0 < volume < vector(table, "size")[row].prod():
                failures.append(f"surfaces: the polyhedron of body {table['id'][row]:g} has a volume of {volume}")
            worst["polyhedra"] = max(worst["polyhedra"], difference(2 * numpy.abs(local).max(axis=0), vector(table, "size")[row]))
    for name, most in worst.items():
        report("surfaces", name, len(tables), most, ROUNDING)


def read_axes(file, tables):
    worst = {"ends": 0.0, "radius": 0.0}
    for parts, table in zip(read_collection(file), tables, strict=True):
        found = {}
        for part in parts:
            for k, ends in enumerate(cells_of(part, part.GetLines())):
                radii = [part.GetPointData().GetArray("radius").GetValue(2 * k + end) for end in range(2)]
                found[int(part.GetPointData().GetArray("id").GetValue(2 * k))] = (ends, radii)
        rows = numpy.flatnonzero(numpy.isin(table["shape"], (TUBE, CAPSULE, CYLINDER)))
        if set(found) != set(table["id"][rows]):
            failures.append(f"axes: of other bodies than the table's, {len(found)}")
            continue
        size = vector(table, "size")[rows]
        half = (size[:, 2] - numpy.where(table["shape"][rows] == CAPSULE, size[:, 0], 0)) / 2
        local = numpy.zeros((len(rows), 2, 3))
        local[:, 0, 2], local[:, 1, 2] = -half, half
        for row, ends in zip(rows, turned(table, rows, local)):
            worst["ends"] = max(worst["ends"], difference(found[int(table["id"][row])][0], ends))
            worst["radius"] = max(worst["radius"], difference(found[int(table["id"][row])][1], [table["size_x"][row] / 2] * 2))
    for name, most in worst.items():
        report("axes", name, len(tables), most, ROUNDING)


def main():
    scree, run = sys.argv[1], Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for word in ("csv", "vtp", "xyz", "lammps"):
            subprocess.run([scree, "export", run, "--to", word, "-o", folder], check=True, stdout=subprocess.DEVNULL)
        tables = [table_of(file) for file in sorted((folder / "csv").iterdir())]
        print(f"VTK {vtk.vtkVersion().GetVTKVersion()}, ASE {ase.__version__}")
        read_vtkhdf(run / "trajectory.vtkhdf", tables, 1)
        read_vtp(folder / "vtp", tables, 1)
        read_xyz(folder, tables)
        read_dump(folder, tables)
        if (folder / "surfaces.pvd").exists():
            read_surfaces(folder / "surfaces.pvd", tables)
        if (folder / "axes.pvd").exists():
            read_axes(folder / "axes.pvd", tables)
        if import_file:
            for name in ("trajectory.xyz", "trajectory.lammpstrj"):
                read_with_ovito(folder / name, tables)
        contacts = [table_of(file) for file in sorted((folder / "contacts").glob("*.csv"))]
        print(f"contacts: {sum(len(table['id']) for table in contacts) // 2}")
        read_vtkhdf(run / "contacts.vtkhdf", contacts, 2)
        read_vtp(folder / "contacts", contacts, 2)
    for failure in failures:
        print("DIFFERENT:", failure)
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
