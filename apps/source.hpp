// SPDX-License-Identifier: Apache-2.0
/// \file
/// What a solid is made from: files of any kind with the options that say what in them is solid, or a function.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "documents.hpp"
#include "inputs.hpp"
#include "readable.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace scaleaxis::app {

/// A function, where it is asked, and its smallest feature.
struct FunctionChoice {
    std::string expression;  ///< empty: none
    std::vector<double> bounds;
    double smallest_feature = 0.0;  ///< 0: the default
    bool is_clipped = false;        ///< closed by the bounds
};

struct SourceOptions {
    LoadOptions load;
    std::vector<std::string> labels = {};  ///< as they are given: those of `load`, or their names
    bool is_each_label = false;
    bool is_each_object = false;
    FunctionChoice function;
    std::string format;                   ///< the extension that the input would have; empty: its name or content tells
    std::vector<std::string> given = {};  ///< the names of all options for solids that are
};

/// Are several solids made from one input?
inline bool is_each(const SourceOptions& options) { return options.is_each_label || options.is_each_object; }

/// `--as`
void add_kind_option(CommandLine command, std::optional<FileKind>& kind);
/// `--solid` and what belongs to it. \param group of the help; empty: none
void add_solid_options(CommandLine command, SolidOptions& options, const std::string& group = "");
/// \param for_solids other options of the command that say how something is made of a solid
void add_source_options(CommandLine command, SourceOptions& options, const std::vector<std::string>& for_solids = {});

/// That no option for solids is given which has no effect. \param what the input is, as a message goes on
/// \param used those that have one \throws InvalidOption
void check_unused(const SourceOptions& options, const std::string& what, const std::vector<std::string>& used);
/// The same for an axis that is there already.
void check_unused_beside_axis(const SourceOptions& options, const std::vector<std::string>& used = {"--format"});

Json to_json(const SourceOptions& options);

/// An image and what there is to tell about it, for all solids that are made from it.
struct LabelImage {
    Image image;
    ImageReport report;
    std::vector<StageCost> costs;  ///< of the reading
};

/// Reads images and keeps the last one. Not for several threads at once.
class ImageReader {
   public:
    /// \throws FileError, InvalidOption if it is no image
    const LabelImage& read(const std::filesystem::path& file, const SourceOptions& options);

   private:
    std::filesystem::path file_;
    LabelImage image_;
};

/// Reads meshes and keeps the last one, for all solids that are made from its objects.
class ObjectReader {
   public:
    /// \throws FileError, InvalidOption if it is no mesh
    const MeshObjects& read(const std::filesystem::path& file, const SourceOptions& options);

   private:
    std::filesystem::path file_;
    MeshObjects objects_;
};

/// One solid to be. Its `name` is what messages and output files call it after.
struct Source {
    std::filesystem::path name;
    std::filesystem::path file;  ///< empty for a function
    SourceOptions options;
    std::shared_ptr<ImageReader> images = {};           ///< of a label: what has read the image already; else null
    std::shared_ptr<ObjectReader> meshes = {};          ///< of an object: the same
    std::string origin = {};                            ///< of an input that a list names: where (see inputs.hpp)
    std::optional<LabelCount> label = {};               ///< with `--each-label`
    std::shared_ptr<const ReadableFile> readable = {};  ///< `file`, if it was read already; else null
    bool is_axis = false;                               ///< there already, of commands that take one input
};

/// The sources that inputs and options mean, with `--each-label` one for each label, with
/// `--each-object` one for each object.
/// \throws InvalidOption if they do not go together
std::vector<Source> sources_of(const std::vector<Input>& inputs, const SourceOptions& options);

/// What `read(path)` returns for the file of a source.
template <class Read>
auto reading(const Source& source, const Read& read) {
    return source.readable ? reading(*source.readable, read) : reading(source.file, source.options.format, read);
}

/// Reads what the source is made from and makes it a solid. A source with `images` is read by these: then several
/// threads may load its labels at once, while the reader keeps the image.
/// \param warn is told each warning as it arises
/// \throws FileError, UnusableInput, InvalidOption, Cancelled
LoadedSolid load_source(const Source& source, const Execution& execution,
                        const std::function<void(const Diagnostic&)>& warn = {}, bool keeps_mesh = false);

/// The mesh of a solid that was loaded with `keeps_mesh`; of one that has none the triangles between samples.
TriangleMesh take_surface(LoadedSolid& input, const std::optional<Length>& delta, std::uint64_t seed,
                          const Execution& execution);

/// From one voxel of an image to the next, along each of its axes.
std::array<Point, 3> steps_of(const ImageReport& report);

/// \param is_given whether options of the sampling are given \throws InvalidOption if `--points crust` is given, too
void check_sampling_options(const SourceOptions& options, bool is_given);

/// \throws InvalidOption if fitted balls are asked for, but the input is samples without a solid
void check_can_fit(const LoadedSolid& input, const std::optional<UnionKind>& kind);

/// That points which are the samples already, as it turned out, take no options of the sampling.
Diagnostic unused_sampling_options();

}  // namespace scaleaxis::app
