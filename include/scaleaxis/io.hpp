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

#include "scaleaxis/field.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

/// What a file holds.
enum class FileKind {
    kMesh,   ///< for `read_mesh`
    kBalls,  ///< for `read_balls`
    kAxis,   ///< for `read_axis`: PLY with `radius` and faces or edges, .ma
};

/// \throws FileError if the file cannot be read or is of no known format
FileKind file_kind(const std::filesystem::path& file);

/// A mesh from OBJ, OFF, PLY or STL (ascii or binary); polygons are triangulated, STL is welded.
/// \throws FileError naming the file, the line or element where known, and what is wrong
TriangleMesh read_mesh(const std::filesystem::path& file);

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
