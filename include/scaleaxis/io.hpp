// SPDX-License-Identifier: Apache-2.0
/// \file
/// Reading and writing files. The format written follows from the extension, the format read from the content or, where
/// that does not tell, from the extension; docs/formats.md describes each.
///
/// Readers take a file, or its bytes in memory. A pipe (`/dev/stdin`, a named pipe) is read whole, and only once. To
/// query a pipe more than once, read its bytes first:
///
///     const std::vector<std::byte> bytes = read_bytes("/dev/stdin");
///     const FileBytes input{bytes, "stdin"};
///     if (file_kind(input) == FileKind::kMesh) { mesh = read_mesh(input); }
///
/// Everything is written under a temporary name in the same folder and renamed when it is complete; pipes and devices
/// are written to directly, `/dev/stdout` where it stands. Coordinates are written so that reading them gives the same
/// doubles. Where a name has no extension, `format` is that of the file to be written: `"ply"`.
///
/// All errors are `FileError`s whose message names the file, and the line or element where it is known; the codes of
/// their diagnostics are in docs/diagnostics.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/filtration.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/shells.hpp"
#include "scaleaxis/sizes.hpp"

namespace scaleaxis::inline v1 {

struct PointCloud;  // cloud.hpp
struct Skeleton;    // skeleton.hpp

/// The content of a file in memory: of an upload, of an archive, of a pipe.
struct FileBytes {
    std::span<const std::byte> bytes;  ///< not copied, but where a library reads files only (see `read_image`)
    /// Begins messages; its extension tells the format where the bytes do not ("upload.xyz").
    std::string name = "input";
};

/// The bytes of a file, a pipe or a device, up to 2 GiB. \throws FileError
SCALEAXIS_EXPORT std::vector<std::byte> read_bytes(const std::filesystem::path& file);

/// What a file holds.
enum class FileKind {
    kMesh,    ///< for `read_mesh`
    kPoints,  ///< for `read_points`: also OBJ, PLY and OFF without faces
    kBalls,   ///< for `read_balls`
    kAxis,    ///< for `read_axis`: PLY with `radius` and faces or edges, .ma
    kImage,   ///< for `read_image`
};

/// \throws FileError if the file cannot be read or is of no known format
SCALEAXIS_EXPORT FileKind file_kind(const std::filesystem::path& file);
SCALEAXIS_EXPORT FileKind file_kind(const FileBytes& file);

/// The extensions of all formats that are read, in lower case: ".obj", ".nii.gz".
SCALEAXIS_EXPORT std::vector<std::string> input_extensions();

/// A mesh from OBJ, OFF, PLY, STL or VTK; polygons are triangulated, STL is welded. From 3MF and glTF: all
/// objects of the scene together.
/// \throws FileError naming the file, the line or element where known, and what is wrong
SCALEAXIS_EXPORT TriangleMesh read_mesh(const std::filesystem::path& file);
SCALEAXIS_EXPORT TriangleMesh read_mesh(const FileBytes& file);

/// One of the things that a file holds: of a scene, a node with triangles.
struct MeshObject {
    std::string name;   ///< as the file has it; may be empty, and the same as that of another
    TriangleMesh mesh;  ///< at its place in the scene
};

/// All things of a file, and what of it was left out (points and lines, modifiers of slicers).
struct MeshObjects {
    std::vector<MeshObject> objects;
    std::vector<Diagnostic> warnings;
    std::string unit = {};  ///< of lengths, as "mm"; empty where the file does not say: 3MF does
};

/// The same as `read_mesh`, object by object; a file of a format without objects is one without a name.
///
/// Coordinates are in the file's unit and along its axes. The transforms of all nodes above an object are applied; one
/// that mirrors turns the triangles round. A glTF may refer to others with the numbers, which lie in its folder or
/// below; nothing else is read but the file itself. \throws FileError
SCALEAXIS_EXPORT MeshObjects read_objects(const std::filesystem::path& file);
SCALEAXIS_EXPORT MeshObjects read_objects(const FileBytes& file);

/// One mesh of all objects.
SCALEAXIS_EXPORT TriangleMesh joined(std::vector<MeshObject> objects);

/// Points from text (`x y z` or `x y z nx ny nz` a line; .xyz, .pts, .pwn), tables (.csv, .tsv), LAS, PCD or VTK, and
/// the vertices of OBJ, OFF, PLY and STL; with normals, if the file has them. Of six columns of text the last three may
/// be colours. Coordinates need not be finite: `prepare` leaves such points out. \throws FileError naming the line or
/// the point, and what is wrong
SCALEAXIS_EXPORT PointCloud read_points(const std::filesystem::path& file);
SCALEAXIS_EXPORT PointCloud read_points(const FileBytes& file);

/// Balls from PLY (vertices with `radius`), text (`x y z r` a line; .balls, .txt, .xyzr) or mesecina's .woff.
/// \throws FileError
SCALEAXIS_EXPORT std::vector<Ball> read_balls(const std::filesystem::path& file);
SCALEAXIS_EXPORT std::vector<Ball> read_balls(const FileBytes& file);

/// How files and arrays write `VertexOrigin`: the number of the ball, -1 for none, and this where radii are linear.
inline constexpr Index kStoredLinear = -2;

constexpr Index stored_number(const VertexOrigin& origin) { return is_linear(origin) ? kStoredLinear : origin.ball; }

/// \param number as above \param radius of the vertex: those of radius 0 are on sharp edges
constexpr VertexOrigin origin_of(Index number, double radius) {
    if (number >= 0) {
        return {VertexKind::kBall, number};
    }
    const VertexOrigin linear = linear_vertex(radius);
    return number == kStoredLinear || linear.kind == VertexKind::kSharpEdge ? linear : VertexOrigin{};
}

/// A medial axis from PLY (vertices with `radius`, polygons, edges) or .ma, of this library or of others.
///
/// `edges` holds the edges of the file and the sides of all faces, `face_edges` refers to them. What a file does not
/// say is 0 in `face_angles`, and 1 in `scale`; sheets that it does not name are found by `label_sheets`. No file names
/// the contacts: `face_contacts` and the boundary vertices are empty. Where the file does not say which vertices are
/// centres of balls, radii are linear: the balls of a union of other programs need not overlap.
/// \param scale by which the balls had been grown, in place of what the file says: it says that they are a union's
/// \throws FileError naming a radius that is absent or negative, or an edge or face without its vertices
SCALEAXIS_EXPORT MedialComplex read_axis(const std::filesystem::path& file, const std::optional<double>& scale = {});
SCALEAXIS_EXPORT MedialComplex read_axis(const FileBytes& file, const std::optional<double>& scale = {});

/// The factor by which the balls of an axis had been grown, if the file says it: PLY of `write_axis` does.
/// \throws FileError if it cannot be read at all
SCALEAXIS_EXPORT std::optional<double> stored_scale(const std::filesystem::path& file);
SCALEAXIS_EXPORT std::optional<double> stored_scale(const FileBytes& file);

/// A 3D image from NRRD, NIfTI (both versions), MetaImage, TIFF with several pages, VTK (structured points, and .vti),
/// NumPy's .npy and .npz (the first index along x), INRIMAGE, DGtal's .vol and .pgm3d. Spacing, origin and
/// directions are those of the file, in its own coordinates (for NIfTI right-anterior-superior). Data in a file of
/// their own are found beside the head, which is then not read from bytes. \throws FileError also for colours, for more
/// or less than three dimensions, and for values that are not numbers
SCALEAXIS_EXPORT Image read_image(const std::filesystem::path& file);
SCALEAXIS_EXPORT Image read_image(const FileBytes& file);

/// \throws FileError, UnusableInput as `check_balls`
SCALEAXIS_EXPORT void write_balls(const std::filesystem::path& file, std::span<const Ball> balls,
                                  std::string_view format = {});

/// A number of each vertex, and the name that it has in a file.
struct VertexValues {
    std::string name;            ///< letters, digits and underscores; none that the formats have another use for
    std::vector<double> values;  ///< #V; those that are not finite are written as -1, since many readers fail at them
};

struct AxisFileOptions {
    /// PLY alone: the polygons and all edges, in binary, in place of the triangles that more programs read.
    bool has_polygons = false;
    /// What else is known of the vertices, as their erosion thickness; written to PLY and VTP.
    std::vector<VertexValues> vertex_values = {};
    /// PLY and VTP: the scales at which edges (#E) and faces (#F) vanish; `write_filtration` fills them in. Or empty.
    std::vector<double> edge_scales = {};
    std::vector<double> face_scales = {};
    std::optional<double> largest_scale = {};  ///< of these, of a PLY, in a comment
};

/// A medial complex to PLY, .ma, VTP, OBJ or GLB (binary glTF, in single precision). PLY is text of triangles, which
/// `read_axis` puts together again: no vertex, edge or polygon is lost, and a comment says the scale, unless it is 1.
/// What other programs read of it is in docs/formats.md.
/// \throws FileError; before anything is written, UnusableInput if arrays have different lengths or an index is out of
///         range, InvalidOption if values of vertices have no good name or are not as many as the vertices
SCALEAXIS_EXPORT void write_axis(const std::filesystem::path& file, const MedialComplex& complex,
                                 std::string_view format = {}, const AxisFileOptions& options = {});

/// A filtration to PLY or VTP: its complex as `write_axis` has it, with the numbers `ball_scale` and `vanishing_scale`
/// of the vertices, `vanishing_scale` of faces, and of those edges that do not vanish with their last face; -1 for
/// never. \throws as `write_axis`; UnusableInput (see `check`); FileError if the format is another one
SCALEAXIS_EXPORT void write_filtration(const std::filesystem::path& file, const Filtration& filtration,
                                       std::string_view format = {}, bool has_polygons = false);

/// Does a file hold a filtration that `read_filtration` can read? \throws FileError if it cannot be read at all
SCALEAXIS_EXPORT bool is_filtration(const std::filesystem::path& file);
SCALEAXIS_EXPORT bool is_filtration(const FileBytes& file);

/// A filtration from a PLY that `write_filtration` has written. \throws FileError, also where it is only an axis
SCALEAXIS_EXPORT Filtration read_filtration(const std::filesystem::path& file);
SCALEAXIS_EXPORT Filtration read_filtration(const FileBytes& file);

/// Throws `FileError` if no format of `write_balls` (`write_axis`) has this file's extension, or its folder cannot be
/// written to: to be asked before a long computation.
SCALEAXIS_EXPORT void check_balls_output(const std::filesystem::path& file, std::string_view format = {});
SCALEAXIS_EXPORT void check_axis_output(const std::filesystem::path& file, std::string_view format = {});
SCALEAXIS_EXPORT void check_filtration_output(const std::filesystem::path& file, std::string_view format = {});

/// A mesh to PLY (binary), OBJ, OFF or STL (text, which has no vertices that triangles share).
/// \throws FileError, UnusableInput if a triangle has a vertex that is not there, or a vertex is not finite
SCALEAXIS_EXPORT void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh,
                                 std::string_view format = {});
SCALEAXIS_EXPORT void check_mesh_output(const std::filesystem::path& file, std::string_view format = {});  ///< as above

/// A curve skeleton to SWC (a tree for each component; loops are cut, with a comment that says where), GraphML, JSON,
/// VTP (a polyline for each branch, with VMTK's arrays), CSV (`cylinders`) or PLY (an axis). \returns what the format
/// loses, see `tree_warnings`
/// \throws FileError
SCALEAXIS_EXPORT std::vector<Diagnostic> write_skeleton(const std::filesystem::path& file, const Skeleton& skeleton,
                                                        std::string_view format = {});
SCALEAXIS_EXPORT void check_skeleton_output(const std::filesystem::path& file,
                                            std::string_view format = {});  ///< as above

struct ShellFileOptions {
    /// 1: triangles with straight sides; 2: with a vertex in the middle of each side; 0: 2 in CalculiX's format, whose
    /// linear triangles are far too stiff in bending, otherwise 1.
    int order = 0;
};

/// A shell mesh for the finite-element method: to CalculiX or Abaqus (.inp: S3 or S6, an element set and a shell
/// section of the material WALL for each sheet), Nastran (.bdf: CTRIA3 or CTRIA6, a PSHELL for each sheet), Gmsh 4.1
/// (.msh) or VTK
/// (.vtu). Thickness is that of the section where a sheet is even, otherwise one of each node; where uneven sheets
/// meet, the mean of theirs. \throws FileError, InvalidOption
SCALEAXIS_EXPORT void write_shells(const std::filesystem::path& file, const ShellMesh& shells,
                                   const ShellFileOptions& options = {}, std::string_view format = {});
SCALEAXIS_EXPORT void check_shells_output(const std::filesystem::path& file,
                                          std::string_view format = {});  ///< as above

/// Sizes of elements: to a view of Gmsh (.pos; .msh, version 4.1), tetrahedra of `SizeField::background`, which its
/// option -bgm and its field PostView take; or to mmg's .sol, with the sizes at the vertices of the field's surface,
/// and beside it that surface as Medit's .mesh, for mmgs. \throws FileError, Cancelled
SCALEAXIS_EXPORT void write_sizes(const std::filesystem::path& file, const SizeField& sizes,
                                  std::string_view format = {}, const Execution& execution = {});
SCALEAXIS_EXPORT void check_sizes_output(const std::filesystem::path& file,
                                         std::string_view format = {});  ///< as above

/// The mesh of the same name that is written beside a .sol, where programs look for it; of other formats none.
SCALEAXIS_EXPORT std::optional<std::filesystem::path> mesh_beside_sizes(const std::filesystem::path& file,
                                                                        std::string_view format = {});

/// The .sol of a mesh that is there already, as one of tetrahedra for mmg3d. \param mesh in Medit's text format (.mesh)
/// \throws FileError, Cancelled
SCALEAXIS_EXPORT void write_sizes_at(const std::filesystem::path& file, const SizeField& sizes,
                                     const std::filesystem::path& mesh, const Execution& execution = {});

/// A surface cut into the parts that belong to the branches of a skeleton, to binary PLY: vertices with `node`,
/// `branch` and the colour of the branch. \param nodes of its vertices, see `nearest_nodes` \throws FileError,
/// InvalidOption if there are not as many nodes as vertices, UnusableInput as `write_mesh`
SCALEAXIS_EXPORT void write_parts(const std::filesystem::path& file, const TriangleMesh& surface,
                                  const Skeleton& skeleton, std::span<const Index> nodes, std::string_view format = {});
SCALEAXIS_EXPORT void check_parts_output(const std::filesystem::path& file,
                                         std::string_view format = {});  ///< as above

/// A mesh with values of its vertices to PLY (binary), VTP or GLB (in single precision), coloured by the first of them
/// from red, the least value, over yellow and green to blue, the largest.
/// \param values one at least \throws FileError, InvalidOption as `write_axis`, UnusableInput as `write_mesh`
SCALEAXIS_EXPORT void write_surface(const std::filesystem::path& file, const TriangleMesh& mesh,
                                    std::span<const VertexValues> values, std::string_view format = {});
SCALEAXIS_EXPORT void check_surface_output(const std::filesystem::path& file,
                                           std::string_view format = {});  ///< as above

/// All numbers of the vertices of a PLY but their coordinates and colours, as `write_surface` has written them; none of
/// files of other formats. \throws FileError
SCALEAXIS_EXPORT std::vector<VertexValues> read_vertex_values(const std::filesystem::path& file);

/// An image to NRRD or NIfTI (.nii), as 32-bit floats, little endian.
/// \throws FileError
SCALEAXIS_EXPORT void write_image(const std::filesystem::path& file, const Image& image, std::string_view format = {});
SCALEAXIS_EXPORT void check_image_output(const std::filesystem::path& file,
                                         std::string_view format = {});  ///< as above

}  // namespace scaleaxis::inline v1
