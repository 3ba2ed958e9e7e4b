// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reading and writing files. The format written follows from the extension, the format read from the content or, where
/// that does not tell, from the extension; docs/formats.md describes each.
///
/// Everything is written under a temporary name in the same folder and renamed when it is complete. Coordinates are
/// written so that reading them gives the same doubles.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

struct PointCloud;  // points.hpp

/// What a file holds.
enum class FileKind {
    kMesh,    ///< for `read_mesh`
    kPoints,  ///< for `read_points`: also PLY and OFF without faces
    kBalls,   ///< for `read_balls`
    kAxis,    ///< for `read_axis`: PLY with `radius` and faces or edges, .ma
    kImage,   ///< for `read_image`
};

/// \throws FileError if the file cannot be read or is of no known format
FileKind file_kind(const std::filesystem::path& file);

/// A mesh from OBJ, OFF, PLY or STL (ascii or binary); polygons are triangulated, STL is welded.
/// \throws FileError naming the file, the line or element where known, and what is wrong
TriangleMesh read_mesh(const std::filesystem::path& file);

/// Points from text (`x y z` or `x y z nx ny nz` a line; .xyz, .pts, .pwn), PCD, PLY or OFF; with normals, if the file
/// has them. Of six columns of text the last three may be colours.
/// \throws FileError naming the line or the point, and what is wrong
PointCloud read_points(const std::filesystem::path& file);

/// Balls from PLY (vertices with `radius`), text (`x y z r` a line; .balls, .txt, .xyzr) or mesecina's .woff.
/// \throws FileError
std::vector<Ball> read_balls(const std::filesystem::path& file);

/// A medial axis from PLY (vertices with `radius`, polygons, edges) or .ma, of this library or of others.
///
/// `edges` holds the edges of the file and the sides of all faces, `face_edges` refers to them. What a file does not
/// say is `kNone` in `vertex_balls`, and 0 in `face_angles`; sheets that it does not name are found by `label_sheets`.
/// No file names the contacts: `face_contacts` is `kNone`, the boundary vertices are empty. \throws FileError naming a
/// radius that is absent or negative, or an edge or face without its vertices
MedialComplex read_axis(const std::filesystem::path& file);

/// A 3D image from NRRD, NIfTI, MetaImage, TIFF with several pages, VTK (structured points), DICOM (a file, or a folder
/// with one series), where the library was built with the Insight Toolkit; and from INRIMAGE, DGtal's .vol and .pgm3d.
/// Spacing, origin and directions are those of the file, in its own coordinates (for NIfTI right-anterior-superior).
/// \throws FileError also for colours, for more or less than three dimensions, and for values that are not numbers
Image read_image(const std::filesystem::path& file);

/// \throws FileError
void write_balls(const std::filesystem::path& file, std::span<const Ball> balls);

/// A medial complex to PLY, .ma, VTP, OBJ or GLB (binary glTF, in single precision).
/// \throws FileError
void write_axis(const std::filesystem::path& file, const MedialComplex& complex);

/// Throws `FileError` if no format of `write_balls` (`write_axis`) has this file's extension, or its folder cannot be
/// written to: to be asked before a long computation.
void check_balls_output(const std::filesystem::path& file);
void check_axis_output(const std::filesystem::path& file);

/// A mesh to PLY (binary), OBJ, OFF or STL (text, which has no vertices that triangles share).
/// \throws FileError
void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh);
void check_mesh_output(const std::filesystem::path& file);  ///< as above

/// An image to NRRD (32-bit floats, little endian).
/// \throws FileError
void write_image(const std::filesystem::path& file, const Image& image);
void check_image_output(const std::filesystem::path& file);  ///< as above

}  // namespace scaleaxis
