# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Texts of small meshes."""

import base64
import json
import struct

OBJ = """mtllib colors.mtl
o left
v 0 0 0
v 1 0 0
v 0 2 0
usemtl red
f 1 2 3
o right
v 0 0 5
v 1 0 5
v 0 2 5
usemtl blue
f 4 5 6
"""
TEXTURED_OBJ = """mtllib colors.mtl
v 0 0 0
v 1 0 0
v 0 2 0
vt 0 0
vt 1 0
vt 0 1
usemtl red
f 1/1 2/2 3/3
"""
MTL = 'newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n'
_STL = """solid s
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 {y} 0
endloop
endfacet
endsolid s
"""
DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="millimeter" meter="0.001"/><up_axis>Y_UP</up_axis></asset>
  <library_geometries><geometry id="part-mesh" name="part"><mesh>
    <source id="p"><float_array id="pa" count="9">0 0 0 1000 0 0 0 2000 0</float_array>
      <technique_common><accessor source="#pa" count="3" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="s"><node id="n">
    <instance_geometry url="#part-mesh"/></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
"""
BUFFER = struct.pack('<9f', 0, 0, 0, 1, 0, 0, 0, 2, 0)
IN_FILE = 'data:application/octet-stream;base64,' + base64.b64encode(BUFFER).decode()


def stl(y=2):
    """Return a triangle in the text of STL, as wide as y."""
    return _STL.format(y=y)


def gltf(uri='points.bin', count=3, with_view=True, scale=1.0):
    """Return a glTF file of one triangle, whose points are in another file."""
    accessor = {'componentType': 5126, 'type': 'VEC3', 'count': count}
    return json.dumps({
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}],
        'nodes': [{'mesh': 0, 'name': 'part', 'scale': [scale] * 3}],
        'meshes': [{'name': 'part', 'primitives': [{'attributes': {'POSITION': 0}}]}],
        'accessors': [accessor | ({'bufferView': 0} if with_view else {})],
        'bufferViews': [{'buffer': 0, 'byteLength': len(BUFFER)}],
        'buffers': [{'uri': uri, 'byteLength': len(BUFFER)}]})
