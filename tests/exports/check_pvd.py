"""Reads the files of a ParaView collection with VTK and compares with what was exported."""

import json
import os
import sys
from xml.etree import ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

path, expected_path = sys.argv[1:]
with open(expected_path) as file:
    expected = json.load(file)
states = ElementTree.parse(path).getroot().findall("Collection/DataSet")
assert [float(state.get("timestep")) for state in states] == expected["times"]

for k, state in enumerate(states):
    reader = vtkXMLPolyDataReader()
    file = os.path.join(os.path.dirname(path), state.get("file"))
    assert reader.CanReadFile(file), file
    reader.SetFileName(file)
    complaints = []
    reader.AddObserver("ErrorEvent", lambda *_: complaints.append("error"))
    reader.AddObserver("WarningEvent", lambda *_: complaints.append("warning"))
    reader.Update()
    mesh = reader.GetOutput()
    assert not complaints, file
    assert (vtk_to_numpy(mesh.GetPoints().GetData()) == expected["points"][k]).all()
    assert (vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3) == expected["faces"]).all()
    assert mesh.GetNumberOfPolys() == len(expected["faces"]) == mesh.GetNumberOfCells()
    array = lambda data, name: vtk_to_numpy(data.GetArray(name)).tolist()
    assert array(mesh.GetPointData(), "coarseness") == expected["coarseness"][k]
    assert array(mesh.GetPointData(), "red") == [51] * mesh.GetNumberOfPoints()
    assert array(mesh.GetCellData(), "body") == expected["face_part"]
    assert array(mesh.GetCellData(), "panel") == [0, 0, 1, 1, 2, 2, 3, 4, 4]
    assert array(mesh.GetFieldData(), "TimeValue") == [expected["times"][k]]
print("all as expected")
