// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/io.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "axis/complex.hpp"
#include "base/faults.hpp"
#include "base/files.hpp"
#include "base/formats/compressed.hpp"
#include "base/vectors.hpp"
#include "io/checks.hpp"
#include "io/formats.hpp"
#include "io/input_file.hpp"
#include "io/meshes/polygon_mesh.hpp"
#include "io/output_file.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/centerlines.hpp"
#include "scaleaxis/cloud.hpp"
#include "spatial/mesh_parts.hpp"

namespace scaleaxis::inline v1 {

using std::filesystem::path;

namespace {

using namespace io;

/// The reader of a format that knows one object only.
template <ReadMesh* read>
PolygonObjects one_object(std::string_view content, const path&) {
    PolygonObjects result;
    result.objects.push_back({{}, read(content)});
    return result;
}

struct Format {
    std::string_view extension;  ///< in lower case
    IsContent* is_content = nullptr;
    KindOf* kind = nullptr;  ///< null: as the first reader that there is, of an image, mesh, axis, points, balls
    ReadObjects* read_mesh = nullptr;
    ReadPoints* read_points = nullptr;
    ReadBalls* read_balls = nullptr;
    ReadAxis* read_axis = nullptr;
    ReadImage* read_image = nullptr;
    bool is_head_enough = false;  ///< for `read_image`, which reads the rest from the file
    WriteBalls* write_balls = nullptr;
    WriteAxis* write_axis = nullptr;
    WriteMesh* write_mesh = nullptr;
    WriteImage* write_image = nullptr;
    WriteSkeleton* write_skeleton = nullptr;
    WriteParts* write_parts = nullptr;
    WriteSurface* write_surface = nullptr;
    WriteShells* write_shells = nullptr;
    int shell_order = 1;
    WriteSizes* write_sizes = nullptr;
};

constexpr Format ball_text(std::string_view extension) {
    return {.extension = extension,
            .is_content = is_ball_text,
            .read_balls = read_ball_text,
            .write_balls = write_ball_text};
}

constexpr Format points(std::string_view extension, IsContent* is_content, ReadPoints* read) {
    return {.extension = extension, .is_content = is_content, .read_points = read};
}

constexpr Format image(std::string_view extension, IsContent* is_content, ReadImage* read) {
    return {.extension = extension, .is_content = is_content, .read_image = read, .is_head_enough = true};
}

/// An image whose reader takes the whole file.
constexpr Format whole_image(std::string_view extension, IsContent* is_content, ReadImage* read) {
    return {.extension = extension, .is_content = is_content, .read_image = read};
}

/// All formats. A content is taken for the first that recognises it: any of 84 bytes may be an STL file without facets.
constexpr std::array kFormats{
    Format{.extension = ".nrrd",
           .is_content = is_nrrd,
           .read_image = read_nrrd_image,
           .is_head_enough = true,
           .write_image = write_nrrd_image},
    image(".nhdr", is_nrrd, read_nrrd_image),
    Format{.extension = ".nii",
           .is_content = is_nifti,
           .read_image = read_nifti_image,
           .is_head_enough = true,
           .write_image = write_nifti_image},
    image(".nii.gz", is_nifti, read_nifti_image),
    image(".mha", is_meta_image, read_meta_image),
    image(".mhd", is_meta_image, read_meta_image),
    whole_image(".tif", is_tiff, read_tiff_image),
    whole_image(".tiff", is_tiff, read_tiff_image),
    Format{.extension = ".vtk",
           .is_content = is_vtk,
           .kind = vtk_kind,
           .read_mesh = read_vtk_surface,
           .read_points = read_vtk_surface_points,
           .read_image = read_vtk_image,
           .is_head_enough = true},
    image(".npy", is_npy, read_npy_image),
    whole_image(".npz", is_npz, read_npz_image),
    whole_image(".vti", is_vti, read_vti_image),
    image(".inr", is_inr, read_inr_image),
    image(".inr.gz", is_inr, read_inr_image),
    image(".vol", is_vol, read_vol_image),
    whole_image(".pgm3d", is_pgm3d, read_pgm3d_image),
    Format{.extension = ".ply",
           .is_content = is_ply,
           .kind = ply_kind,
           .read_mesh = one_object<read_ply_mesh>,
           .read_points = read_ply_points,
           .read_balls = read_ply_balls,
           .read_axis = read_ply_axis,
           .write_balls = write_ply_balls,
           .write_axis = write_ply_axis,
           .write_mesh = write_ply_mesh,
           .write_skeleton = write_ply_skeleton,
           .write_parts = write_ply_parts,
           .write_surface = write_ply_surface},
    Format{.extension = ".off",
           .is_content = is_off,
           .kind = off_kind,
           .read_mesh = one_object<read_off_mesh>,
           .read_points = read_off_points,
           .write_mesh = write_off_mesh},
    Format{.extension = ".gltf", .is_content = is_gltf, .read_mesh = read_gltf},
    Format{.extension = ".glb",
           .is_content = is_glb,
           .read_mesh = read_gltf,
           .write_axis = write_glb_axis,
           .write_surface = write_glb_surface},
    Format{.extension = ".3mf", .is_content = is_3mf, .read_mesh = read_3mf},
    points(".las", is_las, read_las_points),
    Format{.extension = ".stl",
           .is_content = is_stl,
           .read_mesh = read_stl,
           .read_points = read_stl_points,
           .write_mesh = write_stl_mesh},
    Format{.extension = ".obj",
           .is_content = is_obj,
           .kind = obj_kind,
           .read_mesh = one_object<read_obj_mesh>,
           .read_points = read_obj_points,
           .write_axis = write_obj_axis,
           .write_mesh = write_obj_mesh},
    Format{.extension = ".woff", .is_content = is_woff, .read_balls = read_woff_balls, .write_balls = write_woff_balls},
    Format{.extension = ".ma", .is_content = is_ma, .read_axis = read_ma_axis, .write_axis = write_ma_axis},
    ball_text(".balls"),
    ball_text(".txt"),
    ball_text(".xyzr"),
    points(".xyz", is_point_text, read_point_text),
    points(".pts", is_point_text, read_point_text),
    points(".pwn", is_point_text, read_point_text),
    Format{.extension = ".csv",
           .is_content = is_point_table,
           .read_points = read_point_table,
           .write_skeleton = write_csv_skeleton},
    points(".tsv", is_point_table, read_point_table),
    points(".pcd", is_pcd, read_pcd_points),
    Format{.extension = ".vtp",
           .is_content = is_vtk_surface,
           .kind = vtk_surface_kind,
           .read_mesh = read_vtk_surface,
           .read_points = read_vtk_surface_points,
           .write_axis = write_vtp_axis,
           .write_skeleton = write_vtp_skeleton,
           .write_surface = write_vtp_surface},
    Format{.extension = ".swc", .write_skeleton = write_swc_skeleton},
    Format{.extension = ".graphml", .write_skeleton = write_graphml_skeleton},
    Format{.extension = ".json", .write_skeleton = write_json_skeleton},
    Format{.extension = ".inp", .write_shells = write_inp_shells, .shell_order = 2},
    Format{.extension = ".bdf", .write_shells = write_bdf_shells},
    Format{.extension = ".msh", .write_shells = write_msh_shells, .write_sizes = write_msh_sizes},
    Format{.extension = ".pos", .write_sizes = write_pos_sizes},
    Format{.extension = ".sol", .write_sizes = write_sol_sizes},
    Format{.extension = ".vtu", .write_shells = write_vtu_shells},
};

/// The extensions of the formats that have the function `member`, for a message.
template <class Function>
std::string extensions(Function Format::*member) {
    std::string result;
    for (const Format& format : kFormats) {
        if (format.*member != nullptr) {
            result += (result.empty() ? "" : ", ") + std::string(format.extension);
        }
    }
    return result;
}

/// The format that a file has by its name, if it has the function `member`; null if there is none.
template <class Function>
const Format* by_extension(const path& file, Function Format::*member) {
    const std::string name = to_lower(utf8_of(file.filename()));
    for (const Format& format : kFormats) {
        if (name.ends_with(format.extension) && format.*member != nullptr) {
            return &format;
        }
    }
    return nullptr;
}

template <class Function>
constexpr std::string_view kReadBy = "";
template <>
constexpr std::string_view kReadBy<ReadObjects*> = "meshes";
template <>
constexpr std::string_view kReadBy<ReadPoints*> = "points";
template <>
constexpr std::string_view kReadBy<ReadBalls*> = "balls";
template <>
constexpr std::string_view kReadBy<ReadAxis*> = "axes";
template <>
constexpr std::string_view kReadBy<ReadImage*> = "images";

/// The format that a file has by its content, or else by its name, of those that have the function `member`.
template <class Function>
const Format& select_format(const path& file, std::string_view content, Function Format::*member) {
    if (const std::string advice = advice_for(content); !advice.empty()) {
        throw unsupported(advice);
    }
    for (const Format& format : kFormats) {
        if (format.*member != nullptr && format.is_content(content)) {
            return format;
        }
    }
    if (const Format* format = by_extension(file, member)) {
        return *format;
    }
    const auto other = std::ranges::find_if(
        kFormats, [&](const Format& format) { return format.is_content != nullptr && format.is_content(content); });
    const Format* const found = other != kFormats.end() ? &*other : by_extension(file, &Format::is_content);
    throw FileError(Diagnostic{
        "file.format", (found != nullptr ? "its format, " + std::string(found->extension) + ", is none of " +
                                               std::string(kReadBy<Function>)
                                         : "neither its name nor its content is that of a format that can be read") +
                           ": " + extensions(member)});
}

template <class Function>
Function select_reader(const path& file, std::string_view content, Function Format::*member) {
    return select_format(file, content, member).*member;
}

/// \param format as the caller of `write_…` gives it
template <class Function>
const Format& select_output(const path& file, std::string_view format, Function Format::*member) {
    const path name = format.empty() ? file : path("." + std::string(format));
    if (const Format* found = by_extension(name, member)) {
        return *found;
    }
    const std::string what = format.empty() ? "the name has to end in one of " : "the format has to be one of ";
    throw FileError(Diagnostic{"file.format", "cannot write " + utf8_of(file) + ": " + what + extensions(member)});
}

template <class Function>
Function select_writer(const path& file, std::string_view format, Function Format::*member) {
    return select_output(file, format, member).*member;
}

template <class Function, class... Content>
void write(const path& file, std::string_view format, Function Format::*member, const Content&... content) {
    const auto writer = select_writer(file, format, member);
    OutputFile out(file);
    writer(out, content...);
    out.commit();
}

/// Are there as many values as vertices, under names that files have no other use for?
void check_vertex_values(std::size_t vertices, std::span<const VertexValues> all) {
    constexpr std::array<std::string_view, 7> kTaken{"x", "y", "z", "radius", "ball", "label", "Points"};
    std::vector<std::string_view> names(kTaken.begin(), kTaken.end());
    for (const auto& [name, values] : all) {
        const bool is_word = !name.empty() && std::ranges::all_of(name, [](char c) {
            return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
        });
        require(is_word && std::ranges::find(names, name) == names.end(),
                quoted(std::string_view(name)) +
                    " cannot be the name of values of vertices: it must consist of letters, digits and "
                    "underscores, and stand for nothing else in the file");
        require(values.size() == vertices, "there are " + std::to_string(values.size()) + " values " +
                                               quoted(std::string_view(name)) + " for " + std::to_string(vertices) +
                                               " vertices");
        names.push_back(name);
    }
}

template <class Function>
void check_output(const path& file, std::string_view format, Function Format::*member) {
    select_writer(file, format, member);
    check_output_file(file);
}

/// Has the format numbers of vertices and faces?
void check_filtration_format(const path& file, std::string_view format) {
    const auto writer = select_writer(file, format, &Format::write_axis);
    if (writer != write_ply_axis && writer != write_vtp_axis) {
        throw FileError(Diagnostic{"file.format", "cannot write " + utf8_of(file) +
                                                      ": a filtration needs numbers of vertices and faces, which only "
                                                      ".ply and .vtp have"});
    }
}

/// Fills what a file need not say. \param unnamed of vertices of which it does not say what they are
void complete(MedialComplex& complex, Index unnamed = kNone) {
    const std::vector<std::array<Index, 2>> listed_edges = std::move(complex.edges);
    build_edges(complex, listed_edges);
    for (std::size_t v = complex.vertex_origins.size(); v < complex.vertices.size(); ++v) {
        complex.vertex_origins.push_back(origin_of(unnamed, complex.radii[v]));
    }
    complex.face_angles.resize(complex.faces.size(), 0.0);
    if (complex.face_sheets.empty()) {
        label_sheets(complex);
    } else {
        complex.sheets = *std::ranges::max_element(complex.face_sheets) + 1;
    }
}

/// Normals may have any length. Those whose squared length would overflow or vanish get one near 1.
void scale_extreme(std::vector<Point>& normals) {
    for (Point& normal : normals) {
        const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
        const bool is_extreme = largest > 1e150 || (largest > 0.0 && largest < 1e-150);
        if (is_extreme && is_finite(normal)) {
            normal = {normal.x / largest, normal.y / largest, normal.z / largest};
        }
    }
}

/// Is it the beginning of an image whose reader reads the rest itself?
bool is_head_enough(std::string_view beginning) {
    const auto format = std::ranges::find_if(
        kFormats, [&](const Format& known) { return known.is_content != nullptr && known.is_content(beginning); });
    return format != kFormats.end() && format->is_head_enough;
}

constexpr std::string_view kPacked = ".gz";

/// Every count of elements of a file of at most this size can be held in an `Index`.
constexpr std::size_t kMostBytes = std::numeric_limits<Index>::max();

/// Something to be read: where it is from and what is in it.
struct Source {
    path name;
    std::string_view content;  ///< its beginning only where that is enough
    path file = {};            ///< that may have others with data beside it; empty: there is none
};

FileKind kind_of(const Source& source) {
    const Format& format = select_format(source.name, source.content, &Format::is_content);
    return format.kind != nullptr          ? format.kind(source.content)
           : format.read_image != nullptr  ? FileKind::kImage
           : format.read_mesh != nullptr   ? FileKind::kMesh
           : format.read_axis != nullptr   ? FileKind::kAxis
           : format.read_points != nullptr ? FileKind::kPoints
                                           : FileKind::kBalls;
}

MeshObjects objects_of(const Source& source) {
    const Format& format = select_format(source.name, source.content, &Format::read_mesh);
    PolygonObjects read = format.read_mesh(source.content, source.file);
    MeshObjects result{{}, std::move(read.warnings), std::move(read.unit)};
    for (PolygonObjects::Object& object : read.objects) {
        try {
            result.objects.push_back({object.name, triangulated(std::move(object.mesh))});
        } catch (const FileError& error) {
            throw object.name.empty() ? error
                                      : with_prefix("object " + quoted(std::string_view(object.name)) + ": ", error);
        }
    }
    return result;
}

TriangleMesh mesh_of(const Source& source) { return joined(objects_of(source).objects); }

PointCloud points_of(const Source& source) {
    PointCloud cloud = select_reader(source.name, source.content, &Format::read_points)(source.content);
    scale_extreme(cloud.normals);
    return cloud;
}

/// The same data, which `check` finds no fault with. Those of others are of the file.
template <class Data>
Data checked(Data data, const auto& check) {
    try {
        check(data);
    } catch (const UnusableInput& error) {
        Diagnostic diagnostic = error.diagnostic();
        diagnostic.code = "file.value";
        throw FileError(std::move(diagnostic));
    }
    return data;
}

std::vector<Ball> balls_of(const Source& source) {
    return checked(select_reader(source.name, source.content, &Format::read_balls)(source.content), check_balls);
}

std::optional<double> axis_scale_of(const Source& source) {
    return is_ply(source.content) ? read_ply_scale(source.content) : std::nullopt;
}

bool holds_filtration(const Source& source) { return is_ply(source.content) && is_ply_filtration(source.content); }

/// A scale as it was before `finite_or_minus_one`.
double scale_of(double stored) { return stored == -1.0 ? kNeverVanishes : stored; }

/// When the last face at each edge vanishes. \param none where there is no face
std::vector<double> last_faces_of(const MedialComplex& complex, std::span<const double> face_scales, double none) {
    std::vector<double> result(complex.edges.size(), none);
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (const Index e : complex.face_edges[f]) {
            result[e] = std::max(result[e], face_scales.empty() ? 1.0 : face_scales[f]);
        }
    }
    return result;
}

/// The scales of all edges from those that the file lists; the others vanish with their last face.
std::vector<double> edge_scales_of(const Filtration& filtration, std::span<const std::array<Index, 2>> listed,
                                   std::span<const double> scales) {
    const MedialComplex& complex = filtration.complex;
    std::vector<double> result = last_faces_of(complex, filtration.face_scales, 1.0);
    for (std::size_t i = 0; i < listed.size(); ++i) {
        const std::array<Index, 2> edge{std::min(listed[i][0], listed[i][1]), std::max(listed[i][0], listed[i][1])};
        result[std::ranges::lower_bound(complex.edges, edge) - complex.edges.begin()] = scale_of(scales[i]);
    }
    return result;
}

Filtration filtration_of(const Source& source) {
    if (!holds_filtration(source)) {
        throw FileError(Diagnostic{"file.no_filtration",
                                   "it holds no filtration: a PLY with a number `vanishing_scale` of each vertex and "
                                   "face is expected, as `filtration` makes them"});
    }
    Filtration result;
    StoredScales stored;
    result.complex = read_ply_axis(source.content, stored);
    check_axis(result.complex);
    const std::vector<std::array<Index, 2>> listed = result.complex.edges;
    if (stored.faces.size() != result.complex.faces.size() || stored.edges.size() != listed.size()) {
        throw FileError(Diagnostic{"file.value", "it has no number `vanishing_scale` of each face and edge"});
    }
    complete(result.complex);
    const auto scales = [](std::vector<double> values) {
        std::ranges::transform(values, values.begin(), scale_of);
        return values;
    };
    result.ball_scales = scales(stored.balls.empty() ? stored.vertices : stored.balls);
    result.vertex_scales = scales(stored.vertices);
    result.face_scales = scales(stored.faces);
    result.largest_scale = stored.largest.value_or(result.largest_scale);
    result.edge_scales = edge_scales_of(result, listed, stored.edges);
    return checked(std::move(result), [](const Filtration& filtration) { check(filtration); });
}

MedialComplex axis_of(const Source& source, const std::optional<double>& scale) {
    MedialComplex complex = select_reader(source.name, source.content, &Format::read_axis)(source.content);
    check_axis(complex);
    complete(complex, scale ? kNone : kStoredLinear);
    complex.scale = scale.value_or(complex.scale);
    return complex;
}

Image image_of(const Source& source) {
    return checked(select_reader(source.name, source.content, &Format::read_image)(source.content, source.file),
                   [](const Image& image) { check(image); });
}

/// What `read` returns; its errors with the name of the file.
template <class Read>
auto with_name(const std::string& name, const Read& read) {
    try {
        return read();
    } catch (const FileError& error) {
        throw with_prefix(name + ": ", error);
    } catch (const std::filesystem::filesystem_error& error) {
        throw FileError(Diagnostic{"file.open", name + ": cannot read: " + error.code().message()});
    } catch (const std::length_error&) {
        throw FileError(
            Diagnostic{"file.damaged", name + ": it asks for more memory than there can be: it is damaged"});
    } catch (const std::bad_alloc&) {
        throw FileError(Diagnostic{"file.memory", name + ": there is not enough memory to read it"});
    }
}

/// Is it packed by gzip around a file of any format? Some formats have packed files of their own.
bool is_packed(std::string_view content) {
    return is_gzip(content) && std::ranges::none_of(kFormats, [&](const Format& format) {
               return format.extension.ends_with(kPacked) && format.is_content(content);
           });
}

/// What `of` makes of a content, unpacked where it is packed.
template <class Of>
auto of_unpacked(const Source& source, const Of& of) {
    if (!is_packed(source.content)) {
        return of(source);
    }
    const std::string content = inflated(source.content, kMostBytes + 1);
    check_size(content.size());
    const bool has_ending = to_lower(utf8_of(source.name)).ends_with(kPacked);
    return of(Source{has_ending ? path(source.name).replace_extension() : source.name, content});
}

/// What `of` makes of a file.
template <class Of>
auto read_from(const path& file, const Of& of, bool is_enough(std::string_view) = nullptr) {
    return with_name(utf8_of(file), [&] {
        const std::string content = read_file(file, is_enough);
        return of_unpacked(Source{file, content, is_plain_file(file) ? file : path()}, of);
    });
}

std::string_view text_of(const FileBytes& file) {
    check_size(file.bytes.size());
    return {reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()};
}

template <class Of>
auto read_from(const FileBytes& file, const Of& of) {
    return with_name(file.name, [&] { return of_unpacked(Source{file.name, text_of(file)}, of); });
}

}  // namespace

}  // namespace scaleaxis::inline v1

namespace scaleaxis::io {

void check_size(std::uintmax_t bytes) {
    if (bytes == 0) {
        throw FileError(Diagnostic{"file.open", "cannot read: the file is empty"});
    }
    if (bytes > kMostBytes) {
        throw FileError(Diagnostic{"file.open", "cannot read: the file has " + std::to_string(bytes) +
                                                    " bytes; the largest that can be read has 2 GiB"});
    }
}

std::vector<Index> listed_edges(const MedialComplex& complex, const AxisFileOptions& options) {
    const std::vector<double> last_faces = last_faces_of(complex, options.face_scales, 0.0);
    return indices_where(complex.edges.size(), [&](Index e) {
        return last_faces[e] < (options.edge_scales.empty() ? 1.0 : options.edge_scales[e]);
    });
}

}  // namespace scaleaxis::io

namespace scaleaxis::inline v1 {

std::vector<std::byte> read_bytes(const path& file) {
    return with_name(utf8_of(file), [&] {
        const std::string content = read_file(file);
        const auto bytes = std::as_bytes(std::span(content));
        return std::vector(bytes.begin(), bytes.end());
    });
}

FileKind file_kind(const path& file) { return read_from(file, kind_of, is_head_enough); }
FileKind file_kind(const FileBytes& file) { return read_from(file, kind_of); }

std::vector<std::string> input_extensions() {
    std::vector<std::string> result;
    for (const Format& format : kFormats) {
        if (format.is_content != nullptr) {
            result.emplace_back(format.extension);
        }
    }
    return result;
}

TriangleMesh read_mesh(const path& file) { return read_from(file, mesh_of); }
TriangleMesh read_mesh(const FileBytes& file) { return read_from(file, mesh_of); }

MeshObjects read_objects(const path& file) { return read_from(file, objects_of); }
MeshObjects read_objects(const FileBytes& file) { return read_from(file, objects_of); }

TriangleMesh joined(std::vector<MeshObject> objects) {
    if (objects.size() == 1) {
        return std::move(objects.front().mesh);
    }
    TriangleMesh result;
    for (const MeshObject& object : objects) {
        const auto offset = static_cast<Index>(result.vertices.size());
        result.vertices.insert(result.vertices.end(), object.mesh.vertices.begin(), object.mesh.vertices.end());
        for (const auto& [a, b, c] : object.mesh.triangles) {
            result.triangles.push_back({a + offset, b + offset, c + offset});
        }
    }
    return result;
}

PointCloud read_points(const path& file) { return read_from(file, points_of); }
PointCloud read_points(const FileBytes& file) { return read_from(file, points_of); }

std::vector<Ball> read_balls(const path& file) { return read_from(file, balls_of); }
std::vector<Ball> read_balls(const FileBytes& file) { return read_from(file, balls_of); }

MedialComplex read_axis(const path& file, const std::optional<double>& scale) {
    return read_from(file, [&](const Source& source) { return axis_of(source, scale); });
}

MedialComplex read_axis(const FileBytes& file, const std::optional<double>& scale) {
    return read_from(file, [&](const Source& source) { return axis_of(source, scale); });
}

std::optional<double> stored_scale(const path& file) { return read_from(file, axis_scale_of); }
std::optional<double> stored_scale(const FileBytes& file) { return read_from(file, axis_scale_of); }

bool is_filtration(const path& file) { return read_from(file, holds_filtration); }
bool is_filtration(const FileBytes& file) { return read_from(file, holds_filtration); }

Filtration read_filtration(const path& file) { return read_from(file, filtration_of); }
Filtration read_filtration(const FileBytes& file) { return read_from(file, filtration_of); }

std::vector<VertexValues> read_vertex_values(const path& file) {
    return read_from(file, [](const Source& source) {
        return is_ply(source.content) ? read_ply_values(source.content) : std::vector<VertexValues>();
    });
}

Image read_image(const path& file) { return read_from(file, image_of, is_head_enough); }
Image read_image(const FileBytes& file) { return read_from(file, image_of); }

void write_balls(const path& file, std::span<const Ball> balls, std::string_view format) {
    check_balls(balls);
    write(file, format, &Format::write_balls, balls);
}

void write_axis(const path& file, const MedialComplex& complex, std::string_view format,
                const AxisFileOptions& options) {
    check(complex);
    check_vertex_values(complex.vertices.size(), options.vertex_values);
    write(file, format, &Format::write_axis, complex, options);
}

void write_filtration(const path& file, const Filtration& filtration, std::string_view format, bool has_polygons) {
    check(filtration);
    check_filtration_format(file, format);
    const AxisFileOptions options{.has_polygons = has_polygons,
                                  .vertex_values = {{"ball_scale", filtration.ball_scales},
                                                    {std::string(kVanishingScale), filtration.vertex_scales}},
                                  .edge_scales = filtration.edge_scales,
                                  .face_scales = filtration.face_scales,
                                  .largest_scale = filtration.largest_scale};
    write_axis(file, filtration.complex, format, options);
}

void write_mesh(const path& file, const TriangleMesh& mesh, std::string_view format) {
    check_mesh(mesh);
    write(file, format, &Format::write_mesh, mesh);
}

void write_surface(const path& file, const TriangleMesh& mesh, std::span<const VertexValues> values,
                   std::string_view format) {
    check_mesh(mesh);
    check_vertex_values(mesh.vertices.size(), values);
    require(!values.empty() && !mesh.vertices.empty(), "a coloured surface needs vertices, and a value of each");
    write(file, format, &Format::write_surface, mesh, values);
}

void write_image(const path& file, const Image& image, std::string_view format) {
    write(file, format, &Format::write_image, image);
}

std::vector<Diagnostic> write_skeleton(const path& file, const Skeleton& skeleton, std::string_view format) {
    write(file, format, &Format::write_skeleton, skeleton);
    WriteSkeleton* const writer = select_writer(file, format, &Format::write_skeleton);
    const bool has_trees = writer == write_swc_skeleton || writer == write_csv_skeleton;
    return has_trees ? tree_warnings(skeleton) : std::vector<Diagnostic>();
}

void write_parts(const path& file, const TriangleMesh& surface, const Skeleton& skeleton, std::span<const Index> nodes,
                 std::string_view format) {
    require(nodes.size() == surface.vertices.size(), "there are " + std::to_string(nodes.size()) + " nodes for " +
                                                         std::to_string(surface.vertices.size()) +
                                                         " vertices of a surface");
    check_mesh(surface);
    write(file, format, &Format::write_parts, surface, skeleton, nodes);
}

void write_shells(const path& file, const ShellMesh& shells, const ShellFileOptions& options, std::string_view format) {
    require(options.order >= 0 && options.order <= 2,
            "the order of a shell mesh must be 1 or 2, or 0 for the usual one of the format");
    const Format& found = select_output(file, format, &Format::write_shells);
    OutputFile out(file);
    found.write_shells(out, shells, (options.order == 0 ? found.shell_order : options.order) == 2);
    out.commit();
}

std::optional<path> mesh_beside_sizes(const path& file, std::string_view format) {
    const bool has_mesh = select_writer(file, format, &Format::write_sizes) == write_sol_sizes;
    return has_mesh ? std::optional(path(file).replace_extension(".mesh")) : std::nullopt;
}

void write_sizes(const path& file, const SizeField& sizes, std::string_view format, const Execution& execution) {
    std::optional<OutputFile> surface;
    if (const std::optional<path> mesh = mesh_beside_sizes(file, format)) {
        write_medit_surface(surface.emplace(*mesh), sizes.surface());
    }
    write(file, format, &Format::write_sizes, sizes, execution);
    if (surface) {
        surface->commit();
    }
}

void write_sizes_at(const path& file, const SizeField& sizes, const path& mesh, const Execution& execution) {
    if (select_writer(file, {}, &Format::write_sizes) != write_sol_sizes) {
        throw FileError(Diagnostic{
            "file.format", "cannot write " + utf8_of(file) + ": sizes at the vertices of a mesh are written as .sol"});
    }
    const std::vector<Point> vertices =
        read_from(mesh, [](const Source& source) { return read_medit_vertices(source.content); });
    OutputFile sol(file);
    write_sol(sol, sizes(vertices, execution));
    sol.commit();
}

void check_sizes_output(const path& file, std::string_view format) {
    check_output(file, format, &Format::write_sizes);
    if (const std::optional<path> mesh = mesh_beside_sizes(file, format)) {
        check_output_file(*mesh);
    }
}

void check_balls_output(const path& file, std::string_view format) { check_output(file, format, &Format::write_balls); }

void check_axis_output(const path& file, std::string_view format) { check_output(file, format, &Format::write_axis); }

void check_skeleton_output(const path& file, std::string_view format) {
    check_output(file, format, &Format::write_skeleton);
}

void check_parts_output(const path& file, std::string_view format) { check_output(file, format, &Format::write_parts); }

void check_filtration_output(const path& file, std::string_view format) {
    check_filtration_format(file, format);
    check_axis_output(file, format);
}

void check_mesh_output(const path& file, std::string_view format) { check_output(file, format, &Format::write_mesh); }

void check_surface_output(const path& file, std::string_view format) {
    check_output(file, format, &Format::write_surface);
}

void check_shells_output(const path& file, std::string_view format) {
    check_output(file, format, &Format::write_shells);
}

void check_image_output(const path& file, std::string_view format) { check_output(file, format, &Format::write_image); }

}  // namespace scaleaxis::inline v1
