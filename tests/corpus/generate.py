#!/usr/bin/env python3
"""Writes the PLY, STL, glTF and 3MF files of this folder: most are binary, so this is where to read what is in them."""

import base64
import io
import json
import math
import pathlib
import struct
import zipfile

FOLDER = pathlib.Path(__file__).parent
POINTS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]  # as tetrahedron.off
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
FORMATS = {"<": "binary_little_endian", ">": "binary_big_endian", "": "ascii"}


def put(name, data):
    (FOLDER / name).write_bytes(data.encode("latin-1") if isinstance(data, str) else data)


# --- PLY -------------------------------------------------------------------------------------------------------------

XYZ = "property float x\nproperty float y\nproperty float z\n"
CORNERS = "property list uchar int vertex_indices\n"


def header(order, vertices="4", faces="4", vertex=XYZ, face=CORNERS, extra=""):
    return (f"ply\nformat {FORMATS[order]} 1.0\n{extra}element vertex {vertices}\n{vertex}"
            f"element face {faces}\n{face}end_header\n").encode("latin-1")


def floats(order, points=POINTS):
    return b"".join(struct.pack(order + "3f", *p) for p in points)


def corners(order, faces=FACES):
    return b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)


def lines(rows):
    return "".join(" ".join(str(x) for x in row) + "\n" for row in rows).encode("latin-1")


V, F = lines(POINTS), lines((3, *f) for f in FACES)
ASCII = header("") + V + F

put("tetrahedron_ascii.ply", ASCII)
for order, word in (("<", "little"), (">", "big")):
    put(f"tetrahedron_{word}.ply", header(order) + floats(order) + corners(order))
put("windows_lines.ply", ASCII.replace(b"\n", b"\r\n"))
put("windows_header.ply", header("<").replace(b"\n", b"\r\n") + floats("<") + corners("<"))
put("old_mac_lines.ply", ASCII.replace(b"\n", b"\r"))
put("comments.ply", header("", extra="comment a  comment\nobj_info num_cols 512\ncomment\n") + V + F)
put("blank_lines.ply", header("") + b"\n" + V.replace(b"\n", b"\n\n") + F + b"\n\n")
put("no_final_newline.ply", ASCII[:-1])
put("final_newline.ply", header("<") + floats("<") + corners("<") + b"\n")
put("vertex_index.ply", ASCII.replace(b"vertex_indices", b"vertex_index"))
put("new_type_names.ply", ASCII.replace(b"float", b"float32").replace(b"uchar int", b"uint8 int32"))
put("colours.ply", header("<", vertex="property uchar red\n" + XYZ + "property list uchar short marks\n",
                          face="property uchar flags\n" + CORNERS + "property double quality\n") +
    b"".join(b"\x07" + struct.pack("<3f", *p) + struct.pack("<B2h", 2, 5, 6) for p in POINTS) +
    b"".join(b"\x01" + corners("<", [f]) + struct.pack("<d", 0.5) for f in FACES))
put("unknown_elements.ply", header(">", extra="element material 2\nproperty list ushort double values\nproperty char kind\n") +
    struct.pack(">H2db", 2, 0.5, 0.25, 1) + struct.pack(">Hb", 0, 2) + floats(">") + corners(">"))
put("faces_first.ply", (f"ply\nformat ascii 1.0\nelement face 4\n{CORNERS}element edge 1\nproperty int vertex1\n"
                        f"property int vertex2\nelement vertex 4\n{XYZ}end_header\n").encode() + F + b"0 1\n" + V)
put("integer_coordinates.ply",
    header(">", vertex="property char y\nproperty short x\nproperty int z\n",
           face="property list uint ushort vertex_indices\n") +
    b"".join(struct.pack(">bhi", y, x, z) for x, y, z in POINTS) +
    b"".join(struct.pack(">I3H", 3, *f) for f in FACES))
put("doubles.ply", header("<", vertex=XYZ.replace("float", "double")) +
    b"".join(struct.pack("<3d", *(x / 3 for x in p)) for p in POINTS) + corners("<"))
put("empty_tristrips.ply", header("", extra="element tristrips 0\nproperty list int int vertex_indices\n") + V + F)

put("empty.ply", "")
put("no_magic.ply", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
put("magic_only.ply", "ply\n")
put("gzip.ply", b"\x1f\x8b\x08\0\0\0\0\0\0\3")
put("no_format.ply", ASCII.replace(b"format ascii 1.0\n", b""))
put("format_unknown.ply", ASCII.replace(b"ascii", b"binary_middle_endian"))
put("format_twice.ply", ASCII.replace(b"format ascii 1.0\n", 2 * b"format ascii 1.0\n"))
put("version_two.ply", ASCII.replace(b"1.0", b"2.0", 1))
put("type_unknown.ply", ASCII.replace(b"float x", b"quad x"))
put("header_prose.ply", ASCII.replace(b"element face", b"these are the faces"))
put("header_words.ply", header("", vertices="four") + V + F)
put("header_negative.ply", header("", faces="-4") + V + F)
put("header_promises_billions.ply", header("<", vertices="4000000000") + floats("<") + corners("<"))
put("header_promises_faces.ply", header(">", faces="4000000000") + floats(">") + corners(">"))
put("header_past_integers.ply", header("", vertices="99999999999999999999") + V + F)
put("header_extra_word.ply", header("", vertices="4 4") + V + F)
put("truncated_header.ply", ASCII[:60])
put("no_vertices.ply", header("", vertices="0") + F)
put("no_faces.ply", header("", faces="0") + V)
put("no_face_element.ply", f"ply\nformat ascii 1.0\nelement vertex 4\n{XYZ}end_header\n".encode() + V)
put("no_z.ply", ASCII.replace(b"float z", b"float w"))
put("coordinate_list.ply", ASCII.replace(b"property float z", b"property list uchar float z"))
put("no_corner_list.ply", ASCII.replace(b"vertex_indices", b"corners"))
put("corners_float.ply", ASCII.replace(b"uchar int", b"uchar float"))
put("corners_twice.ply", ASCII.replace(CORNERS.encode(), CORNERS.encode() + CORNERS.replace("indices", "index").encode()))
put("count_float.ply", ASCII.replace(b"uchar int", b"float int"))
put("property_twice.ply", ASCII.replace(b"float z", b"float z\nproperty float x"))
put("property_first.ply", ASCII.replace(b"element vertex", b"property float x\nelement vertex", 1))
put("element_twice.ply", ASCII.replace(b"end_header", b"element face 4\n" + CORNERS.encode() + b"end_header"))
put("no_properties.ply", header("", extra="element nothing 4000000000\n") + V + F)
put("tristrips.ply", header("", extra="element tristrips 1\nproperty list int int vertex_indices\n") + b"4 0 1 2 3\n" + V + F)
put("truncated_vertices.ply", (header("<") + floats("<"))[:-2])
put("truncated_faces.ply", (header(">") + floats(">") + corners(">"))[:-2])
put("truncated_lines.ply", header("") + V + F[:-10])
put("short_line.ply", header("") + V + F.replace(b"3 0 1 3\n", b"3 0 1\n"))
put("list_promises_billions.ply", header("<", face=CORNERS.replace("uchar", "uint")) + floats("<") +
    struct.pack("<I", 4_000_000_000) + 60 * b"\0")
put("skipped_list_promises_billions.ply",
    header("", face="property list uint char marks\n" + CORNERS) + V + b"4000000000 1 1 3 0 1 2\n" + F)
put("list_negative.ply", header("<", face=CORNERS.replace("uchar", "char")) + floats("<") + b"\xff" + corners("<"))
put("coordinate_nan.ply", ASCII.replace(b"0 1 0", b"0 nan 0"))
put("coordinate_nan_little.ply", header("<") + floats("<", POINTS[:3] + [(0, float("nan"), 0)]) + corners("<"))
put("coordinate_infinite_big.ply", header(">") + floats(">", POINTS[:3] + [(0, float("-inf"), 0)]) + corners(">"))
put("index_beyond.ply", header("") + V + F.replace(b"3 2\n", b"4 2\n"))
put("index_beyond_big.ply", header(">") + floats(">") + corners(">", FACES[:3] + [(1, 3, 1 << 24)]))
put("index_negative.ply", header("<") + floats("<") + corners("<", FACES[:3] + [(1, -1, 2)]))
put("index_fraction.ply", header("") + V + F.replace(b"3 2\n", b"3.0 2\n"))
put("index_past_type.ply", header("", face="property list uchar uchar vertex_indices\n") + V + F.replace(b"3 2\n", b"300 2\n"))
put("empty_face.ply", header("<", faces="5") + floats("<") + corners("<") + b"\0")
put("extra_value.ply", header("") + V + F.replace(b"3 2\n", b"3 2 0\n"))
put("vertices_share_lines.ply", header("") + V.replace(b"\n", b" ") + b"\n" + F)
put("long_file.ply", ASCII + b"3 0 1 2\n")
put("trailing_bytes.ply", header("<") + floats("<") + corners("<") + b"\0\1")
put("other_order.ply", header("<") + floats(">") + corners(">"))
put("rubbish.ply", b"ply\n" + bytes((i * i * 7 + i) % 256 for i in range(300)))
put("repeated_index.ply", header("") + V + F.replace(b"3 0 3 2", b"3 0 3 3"))

# --- STL -------------------------------------------------------------------------------------------------------------

TRIANGLES = [[POINTS[v] for v in f] for f in FACES]


def facet(points, normal="0 0 1"):
    rows = "".join("      vertex {} {} {}\n".format(*p) for p in points)
    return f"  facet normal {normal}\n    outer loop\n{rows}    endloop\n  endfacet\n"


def solid(facets, name=" tetrahedron"):
    return f"solid{name}\n" + "".join(facets) + f"endsolid{name}\n"


def binary(triangles, count=None, title=b"binary"):
    count = len(triangles) if count is None else count
    body = b"".join(struct.pack("<12fH", 0, 0, 1, *(x for p in t for x in p), 7) for t in triangles)
    return title.ljust(80, b"\0") + struct.pack("<I", count) + body


TEXT = solid(facet(t) for t in TRIANGLES)
put("tetrahedron_ascii.stl", TEXT)
put("tetrahedron_binary.stl", binary(TRIANGLES))
put("binary_solid.stl", binary(TRIANGLES, title=b"solid of a careless program"))
put("binary_title_ply.stl", binary(TRIANGLES, title=b"ply\n"))
put("two_solids.stl", solid([facet(t) for t in TRIANGLES[:2]], "") + solid([facet(t) for t in TRIANGLES[2:]], " b"))
put("upper_case.stl", TEXT.upper())
put("windows_lines.stl", TEXT.replace("\n", "\r\n"))
put("nan_normals.stl", solid(facet(t, "nan -nan(ind) inf") for t in TRIANGLES))
SIGNED = [[tuple(-0.0 if x == 0 and i % 2 else float(x) for x in p) for p in t] for i, t in enumerate(TRIANGLES)]
put("negative_zeros.stl", binary(SIGNED))

put("empty.stl", "")
put("blank.stl", "\n\n")
put("prose.stl", "This is a description of a tetrahedron, which has four faces and nothing else to say to a reader.\n")
put("rubbish.stl", bytes((i * i * 7 + i) % 256 for i in range(300)))
put("ply.stl", ASCII)
put("truncated_preamble.stl", binary(TRIANGLES)[:83])
put("truncated_binary.stl", binary(TRIANGLES)[:-1])
put("truncated_binary_solid.stl", binary(TRIANGLES, title=b"solid")[:-50])
put("truncated_ascii.stl", TEXT[:300])
put("no_endsolid.stl", TEXT[:TEXT.index("endsolid")])
put("count_huge.stl", binary(TRIANGLES, 4_000_000_000))
put("count_zero.stl", binary([]))
put("long_binary.stl", binary(TRIANGLES) + b"\0\0")
put("coordinate_nan.stl", TEXT.replace("vertex 0 1 0", "vertex 0 nan 0"))
put("coordinate_overflow.stl", TEXT.replace("vertex 0 1 0", "vertex 0 1e999 0"))
put("coordinate_infinite.stl", binary(TRIANGLES[:3] + [[POINTS[0], POINTS[1], (float("inf"), 0, 0)]]))
put("four_vertices.stl", TEXT.replace("    endloop", "      vertex 0 0 0\n    endloop", 1))
put("two_vertices.stl", TEXT.replace("      vertex 1 0 0\n", "", 1))
put("no_facets.stl", solid([]))
put("no_loop.stl", TEXT.replace("    outer loop\n", "", 1))
put("two_coordinates.stl", TEXT.replace("vertex 1 0 0", "vertex 1 0", 1))
put("text_behind.stl", TEXT + "facet\n")
put("degenerate_facet.stl", binary(TRIANGLES + [[POINTS[0], POINTS[0], POINTS[1]]]))
put("duplicate_facet.stl", solid(facet(t) for t in TRIANGLES + TRIANGLES[:1]))


# --- glTF ------------------------------------------------------------------------------------------------------------

def glb(text, binary):
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(binary)) + b"BIN\0" + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def gltf(binary=None, **changes):
    """A tetrahedron: positions as floats, then indices of 16 bits; changes replace parts of the JSON text."""
    whole = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "buffers": [{"byteLength": 72}]}
    whole.update(changes)
    if binary is None:
        binary = floats("<") + struct.pack("<12H", *sum(FACES, ()))
    return glb(json.dumps(whole).encode(), binary)


put("tetrahedron.glb", gltf())
put("moved_nodes.glb", gltf(nodes=[{"children": [1]},
                                   {"mesh": 0, "rotation": [0, 0, 1, 0], "translation": [1, 2, 3]}]))
put("strip.glb", gltf(meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5}]}]))
put("empty.glb", b"")
put("truncated.glb", gltf()[:-10])
put("wrong_length.glb", gltf() + b"more")
put("json_truncated.glb", glb(b'{"asset": {"version": "2.0"', b""))
put("json_nested.glb", glb(b"[" * 4000, b""))
put("node_cycle.glb", gltf(nodes=[{"mesh": 0, "children": [0]}]))
put("count_huge.glb", gltf(accessors=[{"componentType": 5126, "count": 10**15, "type": "VEC3"}]))
put("view_beyond.glb", gltf(bufferViews=[{"buffer": 0, "byteOffset": 2**53 - 1, "byteLength": 48}]))
put("external_buffer.glb", gltf(buffers=[{"byteLength": 72, "uri": "other.bin"}]))
put("draco.glb", gltf(extensionsRequired=["KHR_draco_mesh_compression"]))
put("index_beyond.glb", gltf(binary=floats("<") + struct.pack("<12H", *range(12))))
put("coordinate_nan.glb", gltf(binary=floats("<", [(math.nan, 0, 0)] + POINTS[1:]) + bytes(24)))
put("lines.glb", gltf(meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "mode": 1}]}]))

def gltf_text(uri=None, **changes):
    """The same tetrahedron as text; its buffer is inside unless it is named."""
    data = floats("<") + struct.pack("<12H", *sum(FACES, ()))
    uri = uri or "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    container = gltf(data, buffers=[{"byteLength": 72, "uri": uri}], **changes)
    return container[20:20 + struct.unpack("<I", container[12:16])[0]].rstrip() + b"\n"


put("tetrahedron.gltf", gltf_text())
put("buffer_beside.gltf", gltf_text("tetrahedron%2Ebin"))
put("tetrahedron.bin", floats("<") + struct.pack("<12H", *sum(FACES, ())))
put("two_nodes.gltf", gltf_text(nodes=[{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b", "translation": [3, 0, 0]}],
                                scenes=[{"nodes": [0, 1]}]))
put("buffer_outside.gltf", gltf_text("../tetrahedron.bin"))
put("buffer_address.gltf", gltf_text("https://example.com/a.bin"))
put("buffer_missing.gltf", gltf_text("nowhere.bin"))
put("base64_truncated.gltf", gltf_text("data:;base64,AAAAA"))
put("truncated.gltf", gltf_text()[:300])
put("empty.gltf", b"")


# --- 3MF -------------------------------------------------------------------------------------------------------------

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
RELATIONS = ('<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship '
             'Target="/3D/m.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
MESH = ("<mesh><vertices>" + "".join('<vertex x="%g" y="%g" z="%g"/>' % p for p in POINTS) + "</vertices><triangles>"
        + "".join('<triangle v1="%d" v2="%d" v3="%d"/>' % f for f in FACES) + "</triangles></mesh>")
ITEM = '<item objectid="1"/>'


def model(objects, build=ITEM):
    return f'<?xml version="1.0"?>\n<model unit="inch" xmlns="{CORE}"><resources>{objects}</resources><build>{build}</build></model>\n'


def an_object(number, content):
    return f'<object id="{number}" type="model">{content}</object>'


def components(*numbers):
    return "<components>" + "".join(f'<component objectid="{n}"/>' for n in numbers) + "</components>"


def package(text, method=zipfile.ZIP_DEFLATED, relations=RELATIONS):
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", method) as archive:
        for path, content in (("_rels/.rels", relations), ("3D/m.model", text)):
            if content is not None:
                archive.writestr(zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0)), content, method)
    return memory.getvalue()


PLAIN = package(model(an_object(1, MESH)))
put("tetrahedron.3mf", PLAIN)
put("stored.3mf", package(model(an_object(1, MESH)), zipfile.ZIP_STORED))
put("components.3mf", package(model(
    an_object(1, MESH) + an_object(2, components(1).replace("/>", ' transform="0 1 0 -1 0 0 0 0 1 5 0 0"/>')),
    ITEM + '<item objectid="2" transform="1 0 0 0 1 0 0 0 1 0 0 7"/>')))
put("entities.3mf", package('<!DOCTYPE m [<!ENTITY a "aaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><model unit="&b;"/>'))
put("zip_bomb.3mf", package(model(an_object(1, MESH)) + " " * 8_000_000))
put("component_cycle.3mf", package(model(an_object(1, components(2)) + an_object(2, components(1)))))
put("component_bomb.3mf", package(model(
    an_object(1, MESH) + "".join(an_object(k, components(*[k - 1] * 10)) for k in range(2, 20)),
    '<item objectid="19"/>')))
put("no_items.3mf", package(model(an_object(1, MESH), "")))
put("index_beyond.3mf", package(model(an_object(1, MESH.replace('v3="3"', 'v3="9"')))))
put("coordinate_nan.3mf", package(model(an_object(1, MESH.replace('x="1"', 'x="nan"')))))
put("no_model.3mf", package(None))
put("no_relations.3mf", package(model(an_object(1, MESH)), relations=None))
put("truncated.3mf", PLAIN[:len(PLAIN) // 2])
put("damaged.3mf", PLAIN.replace(b"3D/m.model", b"3D/m.modeL", 1)[:-40] + PLAIN[-40:-30] + b"\xff" + PLAIN[-29:])
put("empty.3mf", b"")
