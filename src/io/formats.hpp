// SPDX-License-Identifier: Apache-2.0
/// \file
/// The readers and writers of all formats, one source file each; io.cpp has the table that chooses among them.
///
/// Readers take the whole content of a file and throw a `FileError` that names the line or the element. They check the
/// syntax; `checks.hpp` has what the numbers have to mean.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/output_file.hpp"
#include "io/polygon_mesh.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::io {

/// As values of vertices are written.
inline double finite_or_minus_one(double value) { return std::isfinite(value) ? value : -1.0; }

/// As the scale at which an element vanishes is called in files.
inline constexpr std::string_view kVanishingScale = "vanishing_scale";

/// The edges that a file lists besides its faces: those without faces, and of a filtration those that vanish later than
/// their faces. \returns positions in `edges`
std::vector<Index> listed_edges(const MedialComplex& complex, const AxisFileOptions& options);

// ply.cpp: Stanford polygons, ascii or binary in either byte order
// Triangle strips are read, too.
bool is_ply(std::string_view content);
FileKind ply_kind(std::string_view content);
PolygonMesh read_ply_mesh(std::string_view content);
PointCloud read_ply_points(std::string_view content);
std::vector<Ball> read_ply_balls(std::string_view content);
void write_ply_balls(OutputFile& out, std::span<const Ball> balls);
MedialComplex read_ply_axis(std::string_view content);
void write_ply_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options);
/// The scales at which the elements of an axis vanish, as a file has them.
struct StoredScales {
    std::vector<double> balls;      // #V, or empty
    std::vector<double> vertices;   // #V, or empty: the file holds no filtration
    std::vector<double> faces;      // #F
    std::vector<double> edges;      // of the edges that the file lists
    std::optional<double> largest;  // up to which it was looked, if the file says so
};
MedialComplex read_ply_axis(std::string_view content, StoredScales& scales);
bool is_ply_filtration(std::string_view content);
std::optional<double> read_ply_scale(std::string_view content);

/// All numbers of the vertices but coordinates and colours.
std::vector<VertexValues> read_ply_values(std::string_view content);

// obj.cpp: Wavefront
bool is_obj(std::string_view content);
FileKind obj_kind(std::string_view content);
PolygonMesh read_obj_mesh(std::string_view content);
PointCloud read_obj_points(std::string_view content);
void write_obj_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options);

// off.cpp: Geomview
bool is_off(std::string_view content);
FileKind off_kind(std::string_view content);
PolygonMesh read_off_mesh(std::string_view content);
PointCloud read_off_points(std::string_view content);

// stl.cpp: stereolithography, ascii or binary; equal vertices become one
bool is_stl(std::string_view content);
PolygonMesh read_stl_mesh(std::string_view content);
PointCloud read_stl_points(std::string_view content);

// gltf.cpp: the Khronos Group's scenes, as text or binary; each node with triangles, and each instance, is an object
/// \param folder where files lie that the content refers to; empty: they cannot be read
bool is_gltf(std::string_view content);
bool is_glb(std::string_view content);
PolygonObjects read_gltf(std::string_view content, const std::filesystem::path& folder);

// threemf.cpp: an archive with XML, for 3D printing; what is to be built, item by item
bool is_3mf(std::string_view content);
PolygonObjects read_3mf(std::string_view content, const std::filesystem::path& folder);

// ball_text.cpp: `x y z r` a line, and the same under a `WOFF` header
bool is_woff(std::string_view content);
std::vector<Ball> read_woff_balls(std::string_view content);
void write_woff_balls(OutputFile& out, std::span<const Ball> balls);
bool is_ball_text(std::string_view content);
std::vector<Ball> read_ball_text(std::string_view content);
void write_ball_text(OutputFile& out, std::span<const Ball> balls);

// point_text.cpp: `x y z` or `x y z nx ny nz` a line; the number of points may come first
bool is_point_text(std::string_view content);
PointCloud read_point_text(std::string_view content);

// point_table.cpp: columns separated by commas, semicolons or tabs, perhaps with their names in the first line
bool is_point_table(std::string_view content);
PointCloud read_point_table(std::string_view content);
/// Drops normals that are colours, as the last three of six numbers without names may be: whole numbers up to 255, not
/// those of normals along the axes.
void drop_colors(PointCloud& cloud);

// las.cpp: laser scans, of the American Society for Photogrammetry and Remote Sensing
bool is_las(std::string_view content);
PointCloud read_las_points(std::string_view content);

// pcd.cpp: the Point Cloud Library's, ascii, binary or compressed
bool is_pcd(std::string_view content);
PointCloud read_pcd_points(std::string_view content);

// ma.cpp: the medial axis as triangles, as other programs for medial axes read and write it
bool is_ma(std::string_view content);
MedialComplex read_ma_axis(std::string_view content);
void write_ma_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options);

// vtp.cpp: VTK's polygons, for ParaView
void write_vtp_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options);
void write_vtp_skeleton(OutputFile& out, const Skeleton& skeleton);

// skeleton.cpp: curve skeletons as SWC, GraphML, JSON and PLY, and surfaces in parts
void write_swc_skeleton(OutputFile& out, const Skeleton& skeleton);
void write_graphml_skeleton(OutputFile& out, const Skeleton& skeleton);
void write_json_skeleton(OutputFile& out, const Skeleton& skeleton);
void write_ply_skeleton(OutputFile& out, const Skeleton& skeleton);
void write_ply_parts(OutputFile& out, const TriangleMesh& surface, const Skeleton& skeleton,
                     std::span<const Index> nodes);

// glb.cpp: binary glTF, for browsers and Blender
void write_glb_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options);

// The same formats: a surface with values of its vertices, one of them at least, coloured by the first.
void write_ply_surface(OutputFile& out, const TriangleMesh& mesh, std::span<const VertexValues> values);
void write_vtp_surface(OutputFile& out, const TriangleMesh& mesh, std::span<const VertexValues> values);
void write_glb_surface(OutputFile& out, const TriangleMesh& mesh, std::span<const VertexValues> values);

// write_mesh.cpp: triangle meshes to all formats that they are read from
void write_ply_mesh(OutputFile& out, const TriangleMesh& mesh);
void write_off_mesh(OutputFile& out, const TriangleMesh& mesh);
void write_obj_mesh(OutputFile& out, const TriangleMesh& mesh);
void write_stl_mesh(OutputFile& out, const TriangleMesh& mesh);

// Readers of images. `file` is the one with this content, beside which others with data may be; empty: there is none.

// nrrd_image.cpp: nearly raw raster data, of the Teem library and 3D Slicer
bool is_nrrd(std::string_view content);
Image read_nrrd_image(std::string_view content, const std::filesystem::path& file);
void write_nrrd_image(OutputFile& out, const Image& image);

// nifti_image.cpp: both versions; the first one is written, in one file
bool is_nifti(std::string_view content);
Image read_nifti_image(std::string_view content, const std::filesystem::path& file);
void write_nifti_image(OutputFile& out, const Image& image);

// meta_image.cpp: MetaImage
bool is_meta_image(std::string_view content);
Image read_meta_image(std::string_view content, const std::filesystem::path& file);

// tiff_image.cpp: TIFF with several pages
bool is_tiff(std::string_view content);
Image read_tiff_image(std::string_view content, const std::filesystem::path& file);

// vtk_image.cpp: VTK's structured points
bool is_vtk_image(std::string_view content);
Image read_vtk_image(std::string_view content, const std::filesystem::path& file);

// numpy_image.cpp: an array of NumPy, or an archive with one
bool is_npy(std::string_view content);
Image read_npy_image(std::string_view content, const std::filesystem::path& file);
bool is_npz(std::string_view content);
Image read_npz_image(std::string_view content, const std::filesystem::path& file);

// image_text.cpp: INRIMAGE (also packed by gzip), and DGtal's .vol and .pgm3d (the form in plain text)
bool is_inr(std::string_view content);
Image read_inr_image(std::string_view content, const std::filesystem::path& file);
bool is_vol(std::string_view content);
Image read_vol_image(std::string_view content, const std::filesystem::path& file);
bool is_pgm3d(std::string_view content);
Image read_pgm3d_image(std::string_view content, const std::filesystem::path& file);

// unread.cpp: for a content that is known and not read, what it is and what to do; empty: it is not known
std::string advice_for(std::string_view content);
/// The same for a folder with slices of DICOM.
std::string advice_for_folder(const std::filesystem::path& folder);

// vti.cpp: VTK's images in XML
bool is_vti(std::string_view content);
Image read_vti_image(std::string_view content);

}  // namespace scaleaxis::io
