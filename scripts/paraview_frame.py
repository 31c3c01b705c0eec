#!/usr/bin/env python3
"""Draws one frame of a run with ParaView, only by ParaView's own filters, as the scene's camera sees it.

    xvfb-run -a pvpython scripts/paraview_frame.py RUN EXPORT TIME OUT.png

RUN is the folder of a run with a trajectory, EXPORT is the folder that `scree export RUN --to vtp -o EXPORT` has made of it, and TIME is the time of
the frame (s). Needs Debian's paraview (5.11 or newer), python3-paraview, python3-yaml, xauth and xvfb. Spheres and boxes are drawn as glyphs at the
trajectory's points; meshes and polyhedra are in surfaces.pvd; capsules, cylinders and tubes are lines in axes.pvd, drawn with a tube around them, and
capsules also with a sphere at each end. If the run has contacts, their forces are drawn as tubes into OUT-forces.png.
"""
import math
import sys
from pathlib import Path

import yaml
from paraview.simple import (
    CreateView,
    Glyph,
    Hide,
    MergeBlocks,
    OpenDataFile,
    SaveScreenshot,
    Show,
    Threshold,
    Tube,
    ColorBy,
    GetColorTransferFunction,
)

SPHERE, BOX, CAPSULE = 0, 1, 5


def bodies_of(source, shape):
    # The limits are not both `shape`: for shape 0 they would be ParaView's default, which it widens to the range of the data.
    return Threshold(
        Input=source, Scalars=["POINTS", "shape"], LowerThreshold=shape - 0.5, UpperThreshold=shape + 0.5, ThresholdMethod="Between"
    )


def view_of(scene):
    width, height = scene["render"]["size"]
    camera = scene["render"]["camera"]
    view = CreateView("RenderView")
    view.ViewSize = [width, height]
    view.UseColorPaletteForBackground = 0
    view.Background = [0.88, 0.89, 0.90]
    view.OrientationAxesVisibility = 0
    view.CameraPosition = camera["from"]
    view.CameraFocalPoint = camera["to"]
    view.CameraViewUp = [-g for g in scene["gravity"]]
    view.CameraViewAngle = camera["fov"]
    return view


def color_by_material(display, where):
    ColorBy(display, (where, "material"))
    GetColorTransferFunction("material").RescaleTransferFunction(0, len(scene["materials"]) - 1)
    display.SetScalarBarVisibility(view, False)


def show_glyphs(source, shape, name):
    """Shows the bodies of a shape, each as a glyph of its size, turned by its quaternion, in the colour of its material."""
    bodies = bodies_of(source, shape)
    display = Show(bodies, view)
    display.SetRepresentationType("3D Glyphs")
    display.GlyphType = name
    if name == "Sphere":
        display.GlyphType.ThetaResolution = display.GlyphType.PhiResolution = 24
    display.Scaling = 1
    display.ScaleFactor = 1.0
    display.ScaleMode = "Vector Components"
    display.SelectScaleArray = "size"
    display.Orient = 1
    display.OrientationMode = "Quaternion"
    display.SelectOrientationVectors = "orientation"
    color_by_material(display, "POINTS")
    return bodies


def show_surfaces(file):
    """Shows meshes and polyhedra."""
    surfaces = OpenDataFile(str(file))
    color_by_material(Show(surfaces, view), "CELLS")
    return [surfaces]


def show_axes(file):
    """Shows capsules, cylinders and tubes."""
    axes = MergeBlocks(Input=OpenDataFile(str(file)), OutputDataSetType="Polygonal Mesh")
    solid = Tube(Input=axes, Scalars=["POINTS", "radius"], VaryRadius="By Absolute Scalar", NumberofSides=32, Capping=1)
    ends = Glyph(Input=bodies_of(axes, CAPSULE), GlyphType="Sphere", ScaleArray=["POINTS", "radius"], GlyphMode="All Points")
    ends.ScaleFactor = 2
    ends.GlyphType.ThetaResolution = ends.GlyphType.PhiResolution = 24
    for shown in (solid, ends):
        color_by_material(Show(shown, view), "POINTS")
    return [solid, ends]


def show_forces(file, scene, time):
    contacts = OpenDataFile(str(file))
    view.ViewTime = time
    contacts.UpdatePipeline(time)
    if contacts.GetDataInformation().GetNumberOfPoints() == 0:
        return
    low, high = contacts.PointData["force"].GetRange(-1)
    tubes = Tube(Input=contacts, Vectors=["POINTS", "force"], VaryRadius="By Vector Norm", RadiusFactor=30.0)
    width = math.dist(scene["render"]["camera"]["from"], scene["render"]["camera"]["to"])
    tubes.Radius = 2e-4 * width
    display = Show(tubes, view)
    ColorBy(display, ("POINTS", "force", "Magnitude"))
    GetColorTransferFunction("force").RescaleTransferFunction(low, 0.5 * high)
    display.SetScalarBarVisibility(view, False)


run, export, time, out = Path(sys.argv[1]), Path(sys.argv[2]), float(sys.argv[3]), Path(sys.argv[4])
scene = yaml.safe_load((run / "scene.yaml").read_text())
view = view_of(scene)
trajectory = OpenDataFile(str(export / "trajectory.pvd"))
view.ViewTime = time
trajectory.UpdatePipeline(time)
shown = [show_glyphs(trajectory, SPHERE, "Sphere"), show_glyphs(trajectory, BOX, "Box")]
for name, show in (("surfaces.pvd", show_surfaces), ("axes.pvd", show_axes)):
    if (export / name).exists():
        shown += show(export / name)
SaveScreenshot(str(out), view, ImageResolution=view.ViewSize)
if (export / "contacts.pvd").exists():
    for source in shown:
        Hide(source, view)
    show_forces(export / "contacts.pvd", scene, time)
    SaveScreenshot(str(out.with_name(out.stem + "-forces.png")), view, ImageResolution=view.ViewSize)
