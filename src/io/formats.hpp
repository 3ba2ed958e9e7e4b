// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The readers and writers of all formats, one source file each; io.cpp has the table that chooses among them.
///
/// Readers take the whole content of a file and throw a `FileError` that names the line or the element. They check the
/// syntax; `checks.hpp` has what the numbers have to mean.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "io/output_file.hpp"
#include "io/polygon_mesh.hpp"
#include "scaleaxis/field.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::io {

// ply.cpp: Stanford polygons, ascii or binary in either byte order
bool is_ply(std::string_view content);
FileKind ply_kind(std::string_view content);
PolygonMesh read_ply_mesh(std::string_view content);
std::vector<Ball> read_ply_balls(std::string_view content);
void write_ply_balls(OutputFile& out, std::span<const Ball> balls);
MedialComplex read_ply_axis(std::string_view content);
void write_ply_axis(OutputFile& out, const MedialComplex& complex);

// obj.cpp: Wavefront
bool is_obj(std::string_view content);
PolygonMesh read_obj_mesh(std::string_view content);
void write_obj_axis(OutputFile& out, const MedialComplex& complex);

// off.cpp: Geomview
bool is_off(std::string_view content);
PolygonMesh read_off_mesh(std::string_view content);

// stl.cpp: stereolithography, ascii or binary; equal vertices become one
bool is_stl(std::string_view content);
PolygonMesh read_stl_mesh(std::string_view content);

// ball_text.cpp: `x y z r` a line, and the same under a `WOFF` header
bool is_woff(std::string_view content);
std::vector<Ball> read_woff_balls(std::string_view content);
void write_woff_balls(OutputFile& out, std::span<const Ball> balls);
bool is_ball_text(std::string_view content);
std::vector<Ball> read_ball_text(std::string_view content);
void write_ball_text(OutputFile& out, std::span<const Ball> balls);

// ma.cpp: the medial axis as triangles, as other programs for medial axes read and write it
bool is_ma(std::string_view content);
MedialComplex read_ma_axis(std::string_view content);
void write_ma_axis(OutputFile& out, const MedialComplex& complex);

// vtp.cpp: VTK's polygons, for ParaView
void write_vtp_axis(OutputFile& out, const MedialComplex& complex);

// glb.cpp: binary glTF, for browsers and Blender
void write_glb_axis(OutputFile& out, const MedialComplex& complex);

// write_mesh.cpp: triangle meshes to all formats that they are read from
void write_ply_mesh(OutputFile& out, const TriangleMesh& mesh);
void write_off_mesh(OutputFile& out, const TriangleMesh& mesh);
void write_obj_mesh(OutputFile& out, const TriangleMesh& mesh);
void write_stl_mesh(OutputFile& out, const TriangleMesh& mesh);

// nrrd.cpp: nearly raw raster data, of the Teem library, ITK and 3D Slicer
void write_nrrd_image(OutputFile& out, const Image& image);

}  // namespace scaleaxis::io
