// SPDX-License-Identifier: Apache-2.0
/// \file
/// The readers and writers of all formats, one source file each; io.cpp has the table that chooses among them.
///
/// Readers take the whole content of a file and throw a `FileError` that names the line or the element. They check the
/// syntax; `checks.hpp` has what the numbers have to mean.
#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/meshes/polygon_mesh.hpp"
#include "io/output_file.hpp"
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

/// Is this the content of a file of the format, as far as its beginning tells?
using IsContent = bool(std::string_view content);
IsContent is_ply, is_obj, is_off, is_stl, is_gltf, is_glb, is_3mf, is_woff, is_ball_text, is_point_text, is_point_table,
    is_las, is_pcd, is_ma, is_nrrd, is_nifti, is_meta_image, is_tiff, is_vtk_image, is_vtk_surface, is_vtk, is_vti,
    is_npy, is_npz, is_inr, is_vol, is_pgm3d;

/// What is in a file of a format that may have several things.
using KindOf = FileKind(std::string_view content);
KindOf ply_kind, obj_kind, off_kind, vtk_surface_kind, vtk_kind;

using ReadMesh = PolygonMesh(std::string_view content);
ReadMesh read_ply_mesh;  // Stanford polygons, ascii or binary in either byte order; triangle strips, too
ReadMesh read_obj_mesh;  // Wavefront
ReadMesh read_off_mesh;  // Geomview

/// \param file with this content, beside which those that it refers to are; empty: they cannot be read
using ReadObjects = PolygonObjects(std::string_view content, const std::filesystem::path& file);
ReadObjects read_gltf;         // as text or binary; each node with triangles, and each instance, is an object
ReadObjects read_stl;          // stereolithography, ascii or binary; equal vertices become one
ReadObjects read_vtk_surface;  // VTK's polygons, in XML and the legacy format
ReadObjects read_3mf;          // an archive with XML, for 3D printing; what is to be built, item by item

using ReadPoints = PointCloud(std::string_view content);
ReadPoints read_vtk_surface_points, read_ply_points, read_obj_points, read_off_points, read_stl_points;
ReadPoints read_point_text;   // `x y z` or `x y z nx ny nz` a line; the number of points may come first
ReadPoints read_point_table;  // columns separated by commas, semicolons or tabs, perhaps with their names before them
ReadPoints read_las_points;   // laser scans, of the American Society for Photogrammetry and Remote Sensing
ReadPoints read_pcd_points;   // the Point Cloud Library's, ascii, binary or compressed

/// Drops normals that are colours, as the last three of six numbers without names may be: none is negative, and they
/// are whole numbers up to 255, or up to 1 and not all of length 1.
void drop_colors(PointCloud& cloud);

using ReadBalls = std::vector<Ball>(std::string_view content);
ReadBalls read_ply_balls;
ReadBalls read_ball_text;   // `x y z r` a line
ReadBalls read_woff_balls;  // the same under a `WOFF` header

using ReadAxis = MedialComplex(std::string_view content);
ReadAxis read_ply_axis;
ReadAxis read_ma_axis;  // as triangles, as other programs for medial axes read and write it

/// The scales at which the elements of an axis vanish, as a file has them.
struct StoredScales {
    std::vector<double> balls;      // #V, or empty
    std::vector<double> vertices;   // #V, or empty: the file holds no filtration
    std::vector<double> faces;      // #F
    std::vector<double> edges;      // of the edges that the file lists
    std::optional<double> largest;  // up to which it was looked, if the file says so
};
MedialComplex read_ply_axis(std::string_view content, StoredScales& scales);
IsContent is_ply_filtration;
std::optional<double> read_ply_scale(std::string_view content);

/// All numbers of the vertices but coordinates and colours.
std::vector<VertexValues> read_ply_values(std::string_view content);

/// \param content for most the beginning is enough: what follows is in the file (`data_behind_head`)
/// \param file with this content, beside which others with data may be; empty: there is none
using ReadImage = Image(std::string_view content, const std::filesystem::path& file);
ReadImage read_nrrd_image;   // nearly raw raster data, of the Teem library and 3D Slicer
ReadImage read_nifti_image;  // both versions
ReadImage read_meta_image;   // MetaImage
ReadImage read_tiff_image;   // TIFF with several pages
ReadImage read_vtk_image;    // VTK's structured points
ReadImage read_vti_image;    // VTK's images in XML
ReadImage read_npy_image;    // an array of NumPy
ReadImage read_npz_image;    // an archive with one
ReadImage read_inr_image;    // INRIMAGE, also packed by gzip
ReadImage read_vol_image;    // DGtal's
ReadImage read_pgm3d_image;  // DGtal's in plain text

using WriteBalls = void(OutputFile& out, std::span<const Ball> balls);
WriteBalls write_ply_balls, write_woff_balls, write_ball_text;

using WriteAxis = void(OutputFile& out, const MedialComplex& complex, const AxisFileOptions& options);
WriteAxis write_ply_axis, write_obj_axis, write_ma_axis;
WriteAxis write_vtp_axis;  // VTK's polygons, for ParaView
WriteAxis write_glb_axis;  // binary glTF, for browsers and Blender

using WriteMesh = void(OutputFile& out, const TriangleMesh& mesh);
WriteMesh write_ply_mesh, write_off_mesh, write_obj_mesh, write_stl_mesh;

/// Coloured by the first of the values, of which there is one at least.
using WriteSurface = void(OutputFile& out, const TriangleMesh& mesh, std::span<const VertexValues> values);
WriteSurface write_ply_surface, write_vtp_surface, write_glb_surface;

using WriteImage = void(OutputFile& out, const Image& image);
WriteImage write_nrrd_image;
WriteImage write_nifti_image;  // version 1, in one file

using WriteSkeleton = void(OutputFile& out, const Skeleton& skeleton);
WriteSkeleton write_swc_skeleton, write_csv_skeleton, write_graphml_skeleton, write_json_skeleton, write_ply_skeleton,
    write_vtp_skeleton;

/// \param has_middles whether triangles have vertices in the middle of their sides
using WriteShells = void(OutputFile& out, const ShellMesh& shells, bool has_middles);
WriteShells write_inp_shells, write_bdf_shells, write_msh_shells, write_vtu_shells;

using WriteSizes = void(OutputFile& out, const SizeField& sizes, const Execution& execution);
WriteSizes write_pos_sizes, write_msh_sizes;
WriteSizes write_sol_sizes;  // of the vertices of its surface, which `write_medit_surface` writes
void write_sol(OutputFile& out, std::span<const double> sizes);
void write_medit_surface(OutputFile& out, const TriangleMesh& mesh);
std::vector<Point> read_medit_vertices(std::string_view content);

using WriteParts = void(OutputFile& out, const TriangleMesh& surface, const Skeleton& skeleton,
                        std::span<const Index> nodes);
WriteParts write_ply_parts;

/// For a content that is known and not read (unread.cpp), what it is and what to do; empty: it is not known.
std::string advice_for(std::string_view content);
/// The same for a slice of DICOM alone.
std::string advice_for_dicom(std::string_view content);

}  // namespace scaleaxis::io
