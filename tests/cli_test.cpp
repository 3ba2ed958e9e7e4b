// SPDX-License-Identifier: Apache-2.0
// The program as its users meet it: exit status, streams, files. Its function is called in this process; what needs a
// process of its own (signals, pipes, terminals) starts one.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "axis/complex.hpp"
#include "axis/stages/stages.hpp"
#include "meshes.hpp"
#include "program.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/version.hpp"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Arguments = std::vector<std::string>;

struct Outcome {
    int status = -1;  ///< of a program that was killed: minus the signal
    std::string out;
    std::string err;
};

std::string content(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A box as OFF; `triangles` of its twelve triangles are written.
std::string box_off(double x, double y, double z, double size, int triangles = 12) {
    std::ostringstream text;
    text << "OFF\n8 " << triangles << " 0\n";
    for (int corner = 0; corner < 8; ++corner) {
        text << x + ((corner & 1) != 0 ? size : 0) << ' ' << y + ((corner & 2) != 0 ? size : 0) << ' '
             << z + ((corner & 4) != 0 ? size : 0) << '\n';
    }
    const int faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                              {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    for (int t = 0; t < triangles; ++t) {
        text << "3 " << faces[t][0] << ' ' << faces[t][1] << ' ' << faces[t][2] << '\n';
    }
    return text.str();
}

/// Two boxes as OBJ with a gap between them.
std::string two_boxes_obj(double gap) {
    std::ostringstream text;
    for (int box = 0; box < 2; ++box) {
        std::istringstream off(box_off(box * (1 + gap), 0, 0, 1));
        std::string line;
        std::getline(off, line);
        std::getline(off, line);
        for (int i = 0; i < 8; ++i) {
            std::getline(off, line);
            text << "v " << line << '\n';
        }
        for (int i = 0; i < 12; ++i) {
            int count = 0, a = 0, b = 0, c = 0;
            off >> count >> a >> b >> c;
            text << "f " << a + 1 + 8 * box << ' ' << b + 1 + 8 * box << ' ' << c + 1 + 8 * box << '\n';
        }
    }
    return text.str();
}

/// Binary, with a head that says that there are no facets.
std::string stl_without_count(const scaleaxis::TriangleMesh& mesh) {
    std::string stl(84, '\0');
    for (const auto& triangle : mesh.triangles) {
        std::array<float, 12> facet{};
        for (std::size_t k = 0; k < 3; ++k) {
            const scaleaxis::Point& p = mesh.vertices[triangle[k]];
            facet[3 * k + 3] = static_cast<float>(p.x);
            facet[3 * k + 4] = static_cast<float>(p.y);
            facet[3 * k + 5] = static_cast<float>(p.z);
        }
        stl.append(reinterpret_cast<const char*>(facet.data()), sizeof(facet)).append(2, '\0');
    }
    return stl;
}

/// Two objects, boxes of size 1 with a gap between them.
void write_two_boxes_gltf(const fs::path& file, double gap) {
    const scaleaxis::TriangleMesh box = scaleaxis::test::box_mesh({0, 0, 0}, {1, 1, 1});
    std::ofstream data(fs::path(file).replace_extension("bin"), std::ios::binary);
    for (const scaleaxis::Point& p : box.vertices) {
        const std::array<float, 3> place{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        data.write(reinterpret_cast<const char*>(place.data()), sizeof(place));
    }
    data.write(reinterpret_cast<const char*>(box.triangles.data()), 12 * sizeof(box.triangles[0]));
    const Json views = Json::array({{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 96}},
                                    {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 144}}});
    const Json accessors =
        Json::array({{{"bufferView", 0}, {"componentType", 5126}, {"count", 8}, {"type", "VEC3"}},
                     {{"bufferView", 1}, {"componentType", 5125}, {"count", 36}, {"type", "SCALAR"}}});
    const Json primitive{{"attributes", {{"POSITION", 0}}}, {"indices", 1}};
    const Json nodes = Json::array({{{"mesh", 0}}, {{"mesh", 0}, {"translation", {1.0 + gap, 0, 0}}}});
    const Json scene{{"asset", {{"version", "2.0"}}},
                     {"buffers", Json::array({{{"uri", file.stem().string() + ".bin"}, {"byteLength", 240}}})},
                     {"bufferViews", views},
                     {"accessors", accessors},
                     {"meshes", Json::array({{{"primitives", Json::array({primitive})}}})},
                     {"nodes", nodes},
                     {"scenes", Json::array({{{"nodes", {0, 1}}}})},
                     {"scene", 0}};
    write(file, scene.dump());
}

/// While it lives, what is written to a descriptor goes to a file.
class Redirected {
   public:
    Redirected(int descriptor, const fs::path& file) : descriptor_(descriptor), before_(dup(descriptor)) {
        flush();
        const int target = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(target, descriptor_);
        close(target);
    }
    ~Redirected() {
        flush();
        dup2(before_, descriptor_);
        close(before_);
    }
    Redirected(const Redirected&) = delete;
    Redirected& operator=(const Redirected&) = delete;

   private:
    static void flush() {
        std::cout.flush();
        std::cerr.flush();
        std::fflush(nullptr);
    }

    int descriptor_;
    int before_;
};

/// A folder of its own for each test, where the program runs.
class CommandLine : public testing::Test {
   protected:
    void SetUp() override {
        std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        std::replace(name.begin(), name.end(), '/', '_');
        root_ = fs::temp_directory_path() / ("scaleaxis-cli-" + std::to_string(getpid()) + "-" + name);
        folder_ = root_ / "work";
        fs::create_directories(folder_);
        write(folder_ / "box.off", box_off(0, 0, 0, 1));
    }
    void TearDown() override { fs::remove_all(root_); }

    /// Starts the program in the folder. Where `terminal` is a file, it is that of its stderr.
    pid_t start(const Arguments& arguments, int terminal = -1) {
        fs::remove(root_ / "stderr");  // `interrupt` waits for what the new program says
        std::vector<std::string> words{SCALEAXIS_PROGRAM};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& word : words) {
            argv.push_back(word.data());
        }
        argv.push_back(nullptr);
        const std::string out = (root_ / "stdout").string();
        const std::string err = (root_ / "stderr").string();
        const pid_t child = fork();
        if (child == 0) {
            const int flags = O_WRONLY | O_CREAT | O_TRUNC;
            dup2(open(out.c_str(), flags, 0600), STDOUT_FILENO);
            dup2(terminal >= 0 ? terminal : open(err.c_str(), flags, 0600), STDERR_FILENO);
            if (!input_.empty()) {
                dup2(open(input_.c_str(), O_RDONLY), STDIN_FILENO);  // the other end of the pipe writes
            }
            if (file_size_limit_ > 0) {
                const rlimit limit{file_size_limit_, file_size_limit_};
                setrlimit(RLIMIT_FSIZE, &limit);
            }
            if (chdir(folder_.c_str()) == 0) {
                execv(argv[0], argv.data());
            }
            _exit(127);
        }
        return child;
    }

    Outcome wait_for(pid_t child) {
        int status = 0;
        waitpid(child, &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), content(root_ / "stdout"),
                content(root_ / "stderr")};
    }

    /// Calls the program's function.
    Outcome run(const Arguments& arguments) {
        std::vector<const char*> argv{"scaleaxis"};
        for (const std::string& argument : arguments) {
            argv.push_back(argument.c_str());
        }
        const fs::path before = fs::current_path();
        fs::current_path(folder_);
        int status = -1;
        {
            const Redirected out(STDOUT_FILENO, root_ / "stdout");
            const Redirected err(STDERR_FILENO, root_ / "stderr");
            status = scaleaxis::app::run_program(static_cast<int>(argv.size()), argv.data(), {});
        }
        fs::current_path(before);
        return {status, content(root_ / "stdout"), content(root_ / "stderr")};
    }

    /// Runs the program as a process.
    Outcome run_process(const Arguments& arguments) { return wait_for(start(arguments)); }

    /// Runs the program with a pipe as its standard input.
    Outcome run_with_input(const Arguments& arguments, const std::string& text) {
        input_ = root_ / "pipe";
        mkfifo(input_.c_str(), 0600);
        const pid_t child = start(arguments);
        write(input_, text);
        fs::remove(input_);
        input_.clear();
        return wait_for(child);
    }

    /// What the program draws where its stderr is a terminal.
    std::string run_on_terminal(const Arguments& arguments) {
        int controller = -1;
        int terminal = -1;
        const winsize size{24, 120, 0, 0};
        EXPECT_EQ(openpty(&controller, &terminal, nullptr, nullptr, &size), 0);
        setenv("TERM", "xterm", 1);
        const pid_t child = start(arguments, terminal);
        close(terminal);
        std::string drawn;
        std::array<char, 4096> buffer{};
        for (ssize_t count = 0; (count = read(controller, buffer.data(), buffer.size())) > 0;) {
            drawn.append(buffer.data(), static_cast<std::size_t>(count));
        }
        close(controller);
        EXPECT_EQ(wait_for(child).status, 0);
        return drawn;
    }

    /// Starts the program, and sends a signal once it has said on stderr that it is at this stage.
    Outcome interrupt(Arguments arguments, const std::string& stage, int signal) {
        arguments.emplace_back("--verbose");
        const pid_t child = start(arguments);
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (!contains(content(root_ / "stderr"), stage) && std::chrono::steady_clock::now() < deadline) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        kill(child, signal);
        return wait_for(child);
    }

    std::set<std::string> files() const {
        std::set<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
            names.insert(fs::relative(entry.path(), folder_).string());
        }
        return names;
    }

    fs::path root_;
    fs::path folder_;
    fs::path input_;              ///< a pipe as standard input; empty: none
    rlim_t file_size_limit_ = 0;  ///< 0: none
};

const std::string kCat = SCALEAXIS_SOURCE_DIR "/data/cat.obj";

/// One line, and nothing else.
void expect_error_line(const Outcome& outcome, const std::string& part) {
    EXPECT_TRUE(outcome.err.starts_with("scaleaxis: error: ")) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, part)) << outcome.err;
    EXPECT_EQ(outcome.out, "");
}

std::size_t models_of(const std::string& page) {
    std::size_t count = 0;
    const std::string tag = "<script type=\"application/x-scaleaxis\">";
    for (std::size_t at = page.find(tag); at != std::string::npos; at = page.find(tag, at + 1)) {
        ++count;
    }
    return count;
}

TEST_F(CommandLine, HelpNamesEverySubcommandAndItsOptions) {
    const Outcome help = run({"--help"});
    EXPECT_EQ(help.status, 0);
    for (const std::string name : {"axis", "balls", "medial", "filter", "clean", "smooth", "refine", "spheres", "mesh",
                                   "sample-field", "compare", "view", "info", "--version", "Exit status"}) {
        EXPECT_TRUE(contains(help.out, name)) << name;
    }
    const Outcome axis = run({"axis", "--help"});
    EXPECT_EQ(axis.status, 0);
    for (const std::string name : {"--delta", "--delta-abs", "--scale", "--angle", "--no-filter", "--threads", "--seed",
                                   "--stats", "--balls", "--output", "0.01", "1.1", "30", "degrees", "Examples"}) {
        EXPECT_TRUE(contains(axis.out, name)) << name;
    }
    EXPECT_EQ(help.err + axis.err, "");
}

TEST_F(CommandLine, ManualAndCompletionHaveEveryOption) {
    const Outcome manual = run({"--manual"});
    EXPECT_EQ(manual.status, 0);
    EXPECT_TRUE(manual.out.starts_with(".TH SCALEAXIS 1")) << manual.out.substr(0, 100);
    for (const std::string shell : {"bash", "zsh", "fish"}) {
        const std::string script = run({"--completion", shell}).out;
        for (const std::string name : {"sample-field", "skip-existing", "threads", "crust"}) {
            EXPECT_TRUE(contains(script, name)) << shell << ' ' << name;
        }
    }
    EXPECT_TRUE(contains(manual.out, "\\-\\-skip\\-existing"));
    EXPECT_EQ(run({"--completion", "csh"}).status, 2);
    // Bash takes it, and completes.
    write(folder_ / "completion.bash", run({"--completion", "bash"}).out);
    const std::string try_it =
        "cd '" + folder_.string() +
        "' && bash -c '. ./completion.bash; COMP_WORDS=(scaleaxis axis --method la); COMP_CWORD=3; _scaleaxis; "
        "echo ${COMPREPLY[*]}; COMP_WORDS=(scaleaxis axis --ski); COMP_CWORD=2; _scaleaxis; echo ${COMPREPLY[*]}' > "
        "answer";
    ASSERT_EQ(std::system(try_it.c_str()), 0);
    EXPECT_EQ(content(folder_ / "answer"), "lambda\n--skip-existing\n");
}

TEST_F(CommandLine, PrintsItsVersion) {
    const Outcome outcome = run({"--version"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.out, "scaleaxis " SCALEAXIS_VERSION "\n");
}

TEST_F(CommandLine, AProcessEndsWithTheStatusOfItsFunction) {
    for (const Arguments& arguments : {Arguments{"--version"}, Arguments{"info"}, Arguments{"info", "missing.off"},
                                       Arguments{"info", "box.off"}, Arguments{"axis", "sheet.off", "-o", "out.ply"}}) {
        SCOPED_TRACE(testing::PrintToString(arguments));
        write(folder_ / "sheet.off", box_off(0, 0, 0, 1, 1));
        const Outcome process = run_process(arguments);
        const Outcome function = run(arguments);
        EXPECT_EQ(process.status, function.status);
        EXPECT_EQ(process.out, function.out);
        EXPECT_EQ(process.err, function.err);
    }
}

struct WrongUsage {
    std::string name;
    Arguments arguments;
    std::string message;  ///< part of what is said

    friend void PrintTo(const WrongUsage& usage, std::ostream* out) { *out << usage.name; }
};

class WrongUsageTest : public CommandLine, public testing::WithParamInterface<WrongUsage> {};

TEST_P(WrongUsageTest, IsRefusedBeforeTheWorkBegins) {
    const Outcome outcome = run(GetParam().arguments);
    EXPECT_EQ(outcome.status, 2);
    expect_error_line(outcome, GetParam().message);
    EXPECT_EQ(files(), std::set<std::string>{"box.off"});
}

Arguments axis_with(const Arguments& more) {
    Arguments arguments{"axis", "box.off", "-o", "out.ply"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

INSTANTIATE_TEST_SUITE_P(
    CommandLine, WrongUsageTest,
    testing::Values(
        WrongUsage{"NoSubcommand",
                   {},
                   "axis, balls, medial, filtration, filter, clean, smooth, refine, simplify, skeleton, midsurface, "
                   "thickness, walls, sizes, table, spheres, mesh, sample-field, compare, view or info"},
        WrongUsage{"PolygonsOfObj", {"axis", "box.off", "-o", "out.obj", "--polygons"}, "--polygons is for PLY"},
        WrongUsage{"PolygonsOfMaOnStdout",
                   {"clean", "box.off", "-o", "-", "--output-format", "ma", "--polygons"},
                   "--polygons is for PLY"},
        WrongUsage{"MeetingAngle", {"refine", "a.ply", "-o", "b.ply", "--meeting-angle", "20"}, "--meeting-angle"},
        WrongUsage{"UnknownSubcommand", {"skeletonize"}, "skeletonize"},
        WrongUsage{"UnknownOption", axis_with({"--epsilon", "1"}), "--epsilon"},
        WrongUsage{"NoInput", {"axis", "-o", "out.ply"}, "INPUT"},
        WrongUsage{"NoOutput", {"axis", "box.off"}, "--output"},
        WrongUsage{"DeltaZero", axis_with({"--delta", "0"}), "--delta"},
        WrongUsage{"DeltaNegative", axis_with({"--delta", "-0.01"}), "--delta"},
        WrongUsage{"DeltaNaN", axis_with({"--delta", "nan"}), "--delta"},
        WrongUsage{"DeltaNoNumber", axis_with({"--delta", "fine"}), "--delta"},
        WrongUsage{"DeltaTooLarge", axis_with({"--delta", "0.6"}), "--delta"},
        WrongUsage{"AbsoluteDeltaNegative", axis_with({"--delta-abs", "-1"}), "--delta-abs"},
        WrongUsage{"AbsoluteDeltaInfinite", axis_with({"--delta-abs", "inf"}), "--delta-abs"},
        WrongUsage{"DeltaAutoBesideAbsolute", axis_with({"--delta", "auto", "--delta-abs", "0.1"}), "--delta"},
        WrongUsage{"DeltaAutoOfACrust",
                   {"axis", "box.xyz", "-o", "out.ply", "--points", "crust", "--delta", "auto"},
                   "--points crust"},
        WrongUsage{"DeltaAutoOfAMesh", {"mesh", "box.ply", "-o", "out.ply", "--delta", "auto"}, "takes no auto"},
        WrongUsage{"BothDeltas", axis_with({"--delta", "0.1", "--delta-abs", "0.1"}), "--delta"},
        WrongUsage{"ScaleBelowOne", axis_with({"--scale", "0.9"}), "--scale"},
        WrongUsage{"OneScaleOfSeveralBelowOne", axis_with({"--scale", "1.1,0.9"}), "--scale"},
        WrongUsage{"ScaleNaN", axis_with({"--scale", "nan"}), "--scale"},
        WrongUsage{"ScaleTwice", axis_with({"--scale", "1.1,1.10"}), "--scale has the same number twice"},
        WrongUsage{"AngleTooLarge", axis_with({"--angle", "91"}), "--angle"},
        WrongUsage{"AngleAndNoFilter", axis_with({"--angle", "20", "--no-filter"}), "--no-filter"},
        WrongUsage{"ThreadsNegative", axis_with({"--threads", "-1"}), "--threads"},
        WrongUsage{"ThreadsFractional", axis_with({"--threads", "1.5"}), "--threads"},
        WrongUsage{"SeedNegative", axis_with({"--seed", "-1"}), "--seed"},
        WrongUsage{"QuietAndVerbose", axis_with({"-q", "-v"}), "--quiet"},
        WrongUsage{"UnknownExtension", {"axis", "box.off", "-o", "out.jpg"}, "out.jpg"},
        WrongUsage{"NoExtension", {"axis", "box.off", "-o", "out"}, "out"},
        WrongUsage{"FolderBelowAFile", {"axis", "box.off", "-o", "box.off/out.ply"}, "box.off"},
        WrongUsage{"UnknownExtensionInAMissingFolder", {"axis", "box.off", "-o", "nowhere/deep/out.jpg"}, "out.jpg"},
        WrongUsage{"StatisticsAreAFolder", axis_with({"--stats", "."}), "is a folder"},
        WrongUsage{"UnknownExtensionOfBalls", axis_with({"--balls", "out.jpg"}), "out.jpg"},
        WrongUsage{"SeveralInputsForOneOutput", {"axis", "box.off", "other.off", "-o", "out.ply"}, "{name}"},
        WrongUsage{"SameOutputTwice", axis_with({"--balls", "out.ply"}), "out.ply"},
        WrongUsage{"OutputIsInput", {"balls", "box.ply", "-o", "./box.ply"}, "box.ply"},
        WrongUsage{"AbsoluteDeltaOutOfRange", {"balls", "box.off", "-o", "out.ply", "--delta-abs", "5"}, "diagonal"},
        WrongUsage{"BallsToMeshFormat", {"balls", "box.off", "-o", "out.obj"}, "out.obj"},
        WrongUsage{"MedialScaleBelowOne", {"medial", "in.balls", "-o", "out.ply", "--scale", "0.5"}, "--scale"},
        WrongUsage{"MeshToBallFormat", {"mesh", "in.balls", "-o", "out.balls"}, "out.balls"},
        WrongUsage{"MeshDeltaZero", {"mesh", "in.balls", "-o", "out.ply", "--delta", "0"}, "--delta"},
        WrongUsage{"UnknownExtensionOfMesh", axis_with({"--mesh", "out.vtp"}), "out.vtp"},
        WrongUsage{"FieldToMeshFormat", {"sample-field", "in.balls", "-o", "out.ply"}, "out.ply"},
        WrongUsage{
            "FieldTooCoarse", {"sample-field", "in.balls", "-o", "out.nrrd", "--resolution", "4"}, "--resolution"},
        WrongUsage{"ViewToMeshFormat", {"view", "box.off", "-o", "out.ply"}, ".html"},
        WrongUsage{"ViewOverInput", {"view", "box.off", "--shape", "out.html", "-o", "out.html"}, "out.html"},
        WrongUsage{"ViewWithTooManyShapes",
                   {"view", "box.off", "--shape", "box.off", "--shape", "box.off", "-o", "out.html"},
                   "--shape"},
        WrongUsage{"UnknownExtensionOfWalls", {"walls", "box.off", "--min-wall", "1", "-o", "out.zzz"}, ".json"},
        WrongUsage{"UnknownExtensionOfMidsurface",
                   {"midsurface", "box.off", "-o", "out.zzz"},
                   ".ply, .glb, .obj, .ma, .vtp, .stl, .off"},
        WrongUsage{"UnknownExtensionOfView", axis_with({"--view", "out.pdf"}), ".html"},
        WrongUsage{"CompareOfOne", {"compare", "box.off"}, "B"},
        WrongUsage{"CompareTooFine", {"compare", "box.off", "box.off", "--spacing", "0"}, "--spacing"},
        WrongUsage{"ImplicitWithoutBounds", {"axis", "--implicit", "x", "-o", "out.ply"}, "--bounds"},
        WrongUsage{"ImplicitAndFile", axis_with({"--implicit", "x", "--bounds", "0,0,0,1,1,1"}), "box.off"},
        WrongUsage{"BoundsOfFive", {"axis", "--implicit", "x", "--bounds", "0,0,0,1,1", "-o", "out.ply"}, "--bounds"},
        WrongUsage{"BelowWithoutLevel", axis_with({"--below"}), "--iso"},
        WrongUsage{"LevelAndLabel", axis_with({"--iso", "1", "--label", "2"}), "--iso"},
        WrongUsage{"LevelOfAMesh", axis_with({"--iso", "1"}), "iso is for inputs of kind image"},
        WrongUsage{"ObjectZero", axis_with({"--object", "0"}), "--object"},
        WrongUsage{"AbsentObject", axis_with({"--object", "2"}), "there is no object 2: the file has 1"},
        WrongUsage{"ObjectAndEach", axis_with({"--object", "1", "--each-object"}), "--object"},
        WrongUsage{"LabelsAndObjects", axis_with({"--each-label", "--each-object"}), "--each-object"},
        WrongUsage{"CombinedWithoutLabels", axis_with({"--combined", "all.ply"}), "--combined"},
        WrongUsage{"CombinedObj", {"axis", "box.off", "--each-label", "--combined", "all.obj"}, ".ply and .vtp"},
        WrongUsage{"LabelsOfAMesh", axis_with({"--each-label"}), "--each-label is for inputs of kind image"},
        WrongUsage{"ChosenLabelOfAMesh", axis_with({"--label", "1"}),
                   "a choice of labels is for inputs of kind image, this one is of kind mesh: leave it out"},
        WrongUsage{"SmoothingOfAMesh", axis_with({"--mask-smoothing", "0.7"}), "mask smoothing is for inputs"},
        WrongUsage{"PointsOfAMesh", axis_with({"--points", "mls"}), "points method is for inputs of kind points"},
        WrongUsage{"KernelOfAMesh", axis_with({"--kernel", "3"}), "kernel is for inputs of kind points"},
        WrongUsage{"KernelOfTheCrust", axis_with({"--points", "crust", "--kernel", "3"}),
                   "kernel has no effect with the points method crust"},
        WrongUsage{"LevelOfAFunction",
                   {"axis", "--implicit", "x", "--bounds", "0,0,0,1,1,1", "--iso", "1", "-o", "out.ply"},
                   "iso is for inputs of kind image"},
        WrongUsage{"LambdaWithoutItsMethod", axis_with({"--lambda", "0.02"}), "lambda has no effect"},
        WrongUsage{"AngleOfMethodLambda", axis_with({"--method", "lambda", "--angle", "30"}),
                   "no effect with method lambda"},
        WrongUsage{"BothLambdas", axis_with({"--method", "lambda", "--lambda", "0.1", "--lambda-abs", "1"}),
                   "--lambda"},
        WrongUsage{"DeltaOfTheCrust", axis_with({"--points", "crust", "--delta", "0.1"}), "--points crust"},
        WrongUsage{"SamplingOfTheCrust",
                   {"balls", "box.off", "-o", "out.ply", "--points", "crust", "--sampling", "uniform"},
                   "--sampling"},
        WrongUsage{"CleanedAsInThePaper", axis_with({"--paper", "--clean", "0.1"}), "--clean excludes --paper"},
        WrongUsage{"AdaptiveAsInThePaper", axis_with({"--paper", "--sampling", "adaptive"}), "--paper"},
        WrongUsage{"UnknownUnion", axis_with({"--union", "square"}), "square not in {polar,fitted}"},
        WrongUsage{"UnknownSolid", axis_with({"--solid", "foo"}), "foo not in {auto,winding,wrap,thicken}"},
        WrongUsage{"SkipWithASharedPage",
                   {"axis", "box.off", "b.off", "-o", "{name}.ply", "--view", "all.html", "--skip-existing"},
                   "--skip-existing"},
        WrongUsage{"KindOfAFunction",
                   {"axis", "--implicit", "x", "--bounds", "0,0,0,1,1,1", "--as", "mesh", "-o", "out.ply"},
                   "--as"},
        WrongUsage{"VoidsOfAMesh", axis_with({"--fill-voids"}), "fill voids is for inputs"},
        WrongUsage{"SmoothingTooWide", axis_with({"--mask-smoothing", "11"}), "--mask-smoothing"},
        WrongUsage{"UnknownKind", axis_with({"--as", "song"}), "--as"},
        WrongUsage{"NoSource", {"axis", "-o", "out.ply"}, "--implicit"},
        WrongUsage{"NoSourceOfBalls", {"balls", "-o", "out.ply"}, "--implicit"},
        WrongUsage{"InfoOfNothing", {"info"}, "FILE"}),
    [](const auto& test) { return test.param.name; });

struct BadInput {
    std::string name;
    std::string file;
    std::string content;
    int status;
    std::string message;

    friend void PrintTo(const BadInput& input, std::ostream* out) { *out << input.name; }
};

class BadInputTest : public CommandLine, public testing::WithParamInterface<BadInput> {};

TEST_P(BadInputTest, IsNamedAndLeavesNoFile) {
    const auto& [name, file, bytes, status, message] = GetParam();
    if (file == "folder.off") {
        fs::create_directory(folder_ / file);
    } else if (file != "missing.off") {
        write(folder_ / file, bytes);
    }
    const std::set<std::string> before = files();
    const Outcome outcome = run({"axis", file, "-o", "out.ply", "--stats", "-", "-q"});
    EXPECT_EQ(outcome.status, status);
    EXPECT_TRUE(contains(outcome.err, "scaleaxis: error: " + file)) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, message)) << outcome.err;
    EXPECT_EQ(files(), before);
    const Json statistics = Json::parse(outcome.out);
    EXPECT_EQ(statistics["status"], status);
    EXPECT_EQ(statistics["results"][0]["status"], status);
    EXPECT_TRUE(contains(outcome.err, statistics["results"][0]["error"]["message"].get<std::string>()));
}

INSTANTIATE_TEST_SUITE_P(
    CommandLine, BadInputTest,
    testing::Values(BadInput{"Missing", "missing.off", "", 3, "missing.off"},
                    BadInput{"Folder", "folder.off", "", 3, "folder.off"},
                    BadInput{"Empty", "empty.stl", "", 3, "empty.stl"},
                    BadInput{"Garbage", "garbage.ply", std::string("\x7f\x00\xff\x13garbage\x00", 12), 3,
                             "garbage.ply"},
                    BadInput{"Truncated", "short.off", box_off(0, 0, 0, 1).substr(0, 60), 3, "short.off"},
                    BadInput{"NotANumber", "nan.off", "OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", 3, "nan.off"},
                    BadInput{"IndexOutOfRange", "range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", 3, "face 1"},
                    BadInput{"UnknownFormat", "mesh.xyz123", "1 2 3\n", 3, "mesh.xyz123"},
                    BadInput{"Sheet", "sheet.off", box_off(0, 0, 0, 1, 1), 4, "no inside"}),
    [](const auto& test) { return test.param.name; });

/// A label image in DGtal's plain format: blocks of labels 1 and 2 beside each other, and one voxel of 7 at the border.
std::string label_image() {
    std::string text = "X: 16\nY: 12\nZ: 10\nVersion: 2\n.\n";
    for (int k = 0; k < 10; ++k) {
        for (int j = 0; j < 12; ++j) {
            for (int i = 0; i < 16; ++i) {
                const bool is_within = i > 1 && i < 14 && j > 1 && j < 10 && k > 1 && k < 8;
                text += static_cast<char>(is_within ? (i < 8 ? 1 : 2) : i == 0 && j == 0 && k == 0 ? 7 : 0);
            }
        }
    }
    return text;
}

/// The same with plates in place of the blocks.
std::string plate_image() {
    std::string text = label_image();
    const std::size_t begin = text.size() - 16 * 12 * 10;
    for (int voxel = 0; voxel < 16 * 12 * 10; ++voxel) {
        char& label = text[begin + voxel];
        const int k = voxel / (16 * 12);
        label = label == 7 ? label : label == 0 || k == 4 || k == 5 ? 0 : k < 4 ? 1 : 2;
    }
    return text;
}

/// Two cubes whose labels differ in their last digit.
std::string large_labels() {
    std::string text = "#INRIMAGE-4#{\nXDIM=13\nYDIM=7\nZDIM=7\nVDIM=1\nTYPE=float\nPIXSIZE=32 bits\nCPU=decm\n";
    text.resize(252, '\n');
    text += "##}\n";
    for (int voxel = 0; voxel < 13 * 7 * 7; ++voxel) {
        const int i = voxel % 13, j = voxel / 13 % 7, k = voxel / 13 / 7;
        const bool is_within = i % 6 > 0 && i < 12 && j > 0 && j < 6 && k > 0 && k < 6;
        const float label = !is_within ? 0.0F : i < 6 ? 16777215.0F : 16777216.0F;
        text.append(reinterpret_cast<const char*>(&label), sizeof label);
    }
    return text;
}

TEST_F(CommandLine, EachLabelIsAsIfAlone) {
    write(folder_ / "labels.vol", label_image());
    for (const std::string threads : {"1", "3"}) {  // the same bytes, beside each other and each alone
        const std::string folder = "together" + threads + "/";
        const Outcome together = run({"axis", "labels.vol", "--each-label", "-o", folder, "--combined",
                                      folder + "all.ply", "--delta", "0.05", "--threads", threads, "--stats", "-"});
        EXPECT_EQ(together.status, 0) << together.err;
        scaleaxis::MedialComplex expected;
        const Json results = Json::parse(together.out)["results"];
        ASSERT_EQ(results.size(), 3u);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string label = std::vector<std::string>{"1", "2", "7"}[i];
            EXPECT_EQ(results[i]["label"], std::stoi(label));
            EXPECT_EQ(run({"axis", "labels.vol", "--label", label, "-o", "one.ply", "--delta", "0.05"}).status, 0);
            EXPECT_EQ(content(folder_ / folder / ("labels-label" + label + "-axis.ply")), content(folder_ / "one.ply"));
            scaleaxis::append_labelled(expected, scaleaxis::read_axis(folder_ / "one.ply"), std::stoi(label));
        }
        const scaleaxis::MedialComplex all = scaleaxis::read_axis(folder_ / folder / "all.ply");
        EXPECT_EQ(all.vertices, expected.vertices);
        EXPECT_EQ(all.vertex_labels, expected.vertex_labels);
        EXPECT_EQ(all.edges, expected.edges);
        EXPECT_EQ(all.faces.items, expected.faces.items);
        EXPECT_EQ(all.face_sheets, expected.face_sheets);
    }
    EXPECT_EQ(run({"axis", "labels.vol", "--each-label", "--combined", "all.vtp", "--delta", "0.05"}).status, 0);
    EXPECT_TRUE(contains(content(folder_ / "all.vtp"), "Name=\"label\""));
    // One that fails does not keep the others from their results: label 7, a voxel, is too small for this tolerance.
    const Outcome failing = run(
        {"axis", "labels.vol", "--each-label", "--combined", "rest.ply", "--delta-abs", "1.5", "--stats", "rest.json"});
    EXPECT_EQ(failing.status, 2) << failing.err;
    EXPECT_TRUE(contains(failing.err, "labels-label7: ")) << failing.err;
    EXPECT_TRUE(contains(failing.err, "1 of 3 inputs failed")) << failing.err;
    const std::vector<scaleaxis::Index> kept = scaleaxis::read_axis(folder_ / "rest.ply").vertex_labels;
    EXPECT_EQ(std::set<scaleaxis::Index>(kept.begin(), kept.end()), (std::set<scaleaxis::Index>{1, 2}));
    EXPECT_EQ(Json::parse(content(folder_ / "rest.json"))["results"][2]["error"].is_null(), false);
}

TEST_F(CommandLine, EachLabelIsAsIfAloneForAllCommands) {
    write(folder_ / "labels.vol", label_image());
    struct Case {
        std::string command;
        std::string file;  ///< of a label, after its name
        Arguments options;
    };
    write(folder_ / "plates.vol", plate_image());
    const std::vector<Case> cases{{"skeleton", "-skeleton.swc", {}},
                                  {"thickness", "-thickness.ply", {}},
                                  {"spheres", "-spheres.balls", {"--count", "3", "--effort", "0.1"}},
                                  {"midsurface", "-midsurface.ply", {}}};  // a voxel has none
    for (const auto& [command, file, options] : cases) {
        SCOPED_TRACE(command);
        const std::string input = command == "midsurface" ? "plates" : "labels";
        Arguments arguments{command, input + ".vol", "--delta", command == "midsurface" ? "0.05" : "0.1"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const auto with = [&](const Arguments& more) {
            Arguments all = arguments;
            all.insert(all.end(), more.begin(), more.end());
            return run(all);
        };
        const Outcome each = with({"--each-label", "-o", "each/{name}" + file, "--stats", "-"});
        const Json results = Json::parse(each.out)["results"];
        ASSERT_EQ(results.size(), 3U);
        int worst = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::string label = std::vector<std::string>{"1", "2", "7"}[i];
            const std::string name = input + "-label" + label + file;
            const int status = with({"--label", label, "-o", name}).status;
            worst = std::max(worst, status);
            EXPECT_EQ(results[i]["label"], std::stoi(label));
            EXPECT_EQ(results[i]["status"], status);
            EXPECT_EQ(fs::exists(folder_ / "each" / name), status == 0);
            if (status == 0) {
                EXPECT_EQ(results[i]["file"], "each/" + name);
                EXPECT_EQ(content(folder_ / "each" / name), content(folder_ / name));
            }
        }
        EXPECT_EQ(each.status, worst) << each.err;
        EXPECT_EQ(with({"--each-label", "-o", "one" + file}).status, 2) << "three results in one file";
    }
    EXPECT_TRUE(fs::exists(folder_ / "each" / "plates-label2-midsurface.ply"));
    // One that fails is told, and the others are there.
    const Outcome failing =
        run({"skeleton", "labels.vol", "--each-label", "-o", "rest/", "--delta-abs", "1.5", "--stats", "rest.json"});
    EXPECT_EQ(failing.status, 2) << failing.err;
    EXPECT_TRUE(contains(failing.err, "1 of 3 inputs failed")) << failing.err;
    EXPECT_TRUE(fs::exists(folder_ / "rest" / "labels-label2-skeleton.swc"));
    EXPECT_FALSE(fs::exists(folder_ / "rest" / "labels-label7-skeleton.swc"));
    EXPECT_FALSE(Json::parse(content(folder_ / "rest.json"))["results"][2]["error"].is_null());
}

TEST_F(CommandLine, TablesHaveTheVolumeOfTheVoxels) {
    std::string text = "X: 40\nY: 12\nZ: 12\nVersion: 2\n.\n";
    int voxels = 0;
    for (int voxel = 0; voxel < 40 * 12 * 12; ++voxel) {
        const double x = voxel % 40, y = voxel / 40 % 12, z = voxel / 480;
        const bool is_within = x >= 4 && x < 36 && std::hypot(y - 4.0 - 0.1 * x, z - 6.2) < 1.6;
        text += is_within ? '\1' : '\0';
        voxels += is_within ? 1 : 0;
    }
    write(folder_ / "rod.vol", text);
    const Outcome table = run({"table", "rod.vol", "-o", "rod.json", "-q"});
    EXPECT_EQ(table.status, 0) << table.err;
    const auto volume = Json::parse(content(folder_ / "rod.json"))["rows"][0]["volume"].get<double>();
    EXPECT_NEAR(volume / voxels, 1.0, 0.02);
}

TEST_F(CommandLine, TablesHaveTheSizesOfTheUnionOfPartsThatOverlap) {
    scaleaxis::TriangleMesh mesh = scaleaxis::test::box_mesh({0, 0, 0}, {10, 4, 4});
    const scaleaxis::TriangleMesh bar = scaleaxis::test::box_mesh({3, 1, -3}, {6, 3.2, 7});
    const auto first = static_cast<scaleaxis::Index>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), bar.vertices.begin(), bar.vertices.end());
    for (const auto& [a, b, c] : bar.triangles) {
        mesh.triangles.push_back({a + first, b + first, c + first});
    }
    scaleaxis::write_mesh(folder_ / "cross.off", mesh);
    const Outcome table = run({"table", "cross.off", "--delta", "0.02", "-o", "cross.json", "-q"});
    EXPECT_EQ(table.status, 0) << table.err;
    const Json row = Json::parse(content(folder_ / "cross.json"))["rows"][0];
    EXPECT_NEAR(row["volume"].get<double>(), 199.6, 0.01 * 199.6);
    EXPECT_NEAR(row["area"].get<double>(), 254.4, 0.03 * 254.4);
    EXPECT_NEAR(row["minimum_thickness"].get<double>(), 2.2, 0.02 * 2.2);
}

TEST_F(CommandLine, SurfaceLeftOutCountsByItsArea) {
    // A closed cube of side 2, and an open plate of area 4 far above it: 24 of 28 are covered.
    scaleaxis::TriangleMesh mesh = scaleaxis::test::box_mesh({0, 0, 0}, {2, 2, 2});
    const auto first = static_cast<scaleaxis::Index>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{0, 0, 4}, {2, 0, 4}, {2, 2, 4}, {0, 2, 4}});
    mesh.triangles.insert(mesh.triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
    scaleaxis::write_mesh(folder_ / "plate.off", mesh);
    const std::vector<std::string> command{"spheres", "plate.off", "--count", "4", "-o", "plate.json", "-q"};
    const std::vector<std::string> wrap{"--solid", "wrap", "--opening", "0.1"};
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, wrap}) {
        std::vector<std::string> arguments = command;
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        const Json scores = Json::parse(content(folder_ / "plate.json"))["links"][0]["statistics"]["scores"];
        EXPECT_NEAR(scores["surface_coverage"].get<double>(), 24.0 / 28.0, 0.03);
    }
}

TEST_F(CommandLine, WallsThatPartsShareAreNoSurface) {
    scaleaxis::TriangleMesh tower;
    for (int floor = 0; floor < 4; ++floor) {
        const auto first = static_cast<scaleaxis::Index>(tower.vertices.size());
        const scaleaxis::TriangleMesh box = scaleaxis::test::box_mesh({0, 0, 1.0 * floor}, {1, 1, floor + 1.0});
        tower.vertices.insert(tower.vertices.end(), box.vertices.begin(), box.vertices.end());
        for (const auto& [a, b, c] : box.triangles) {
            tower.triangles.push_back({a + first, b + first, c + first});
        }
    }
    scaleaxis::write_mesh(folder_ / "tower.off", tower);
    const Outcome outcome = run({"table", "tower.off", "-o", "tower.json", "-q"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const Json row = Json::parse(content(folder_ / "tower.json"))["rows"][0];
    EXPECT_NEAR(row["area"].get<double>(), 18.0, 0.02 * 18.0);
    EXPECT_NEAR(row["volume"].get<double>(), 4.0, 0.02 * 4.0);
    EXPECT_NEAR(row["mean_thickness"].get<double>(), 1.0, 0.01);
}

TEST_F(CommandLine, PartsWithinOthersCountOnlyIfTheyAreVoids) {
    scaleaxis::TriangleMesh mesh = scaleaxis::test::box_mesh({0, 0, 0}, {4, 4, 4});
    const scaleaxis::TriangleMesh inner = scaleaxis::test::box_mesh({1, 1, 1}, {3, 3, 3});
    const auto first = static_cast<scaleaxis::Index>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
    const std::vector<std::array<scaleaxis::Index, 3>> outer = mesh.triangles;
    for (const bool is_void : {false, true}) {
        mesh.triangles = outer;
        for (const auto& [a, b, c] : inner.triangles) {
            mesh.triangles.push_back({a + first, (is_void ? c : b) + first, (is_void ? b : c) + first});
        }
        scaleaxis::write_mesh(folder_ / "nested.off", mesh);
        const Outcome outcome = run({"table", "nested.off", "-o", "nested.json", "-q"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        const Json row = Json::parse(content(folder_ / "nested.json"))["rows"][0];
        EXPECT_NEAR(row["area"].get<double>(), is_void ? 120.0 : 96.0, 0.02 * 96.0);
        EXPECT_NEAR(row["volume"].get<double>(), is_void ? 56.0 : 64.0, 0.02 * 56.0);
    }
}

TEST_F(CommandLine, WarnsOfThicknessThatVoxelsDoNotResolve) {
    std::string text = "X: 24\nY: 24\nZ: 16\nVersion: 2\n.\n";
    for (int voxel = 0; voxel < 24 * 24 * 16; ++voxel) {
        const int x = voxel % 24, y = voxel / 24 % 24, z = voxel / 576;
        text += x >= 3 && x < 21 && y >= 3 && y < 21 && z == 8 ? '\1' : '\0';
    }
    write(folder_ / "slice.vol", text);
    for (const auto& command : {"table", "thickness"}) {
        const Outcome outcome = run({command, "slice.vol", "-o", "slice.csv", "-q"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_TRUE(contains(outcome.err, "thinner than two voxels across")) << outcome.err;
    }
}

TEST_F(CommandLine, FillsVoids) {
    std::string text = "X: 16\nY: 16\nZ: 16\nVersion: 2\n.\n";
    for (int voxel = 0; voxel < 16 * 16 * 16; ++voxel) {
        const auto is_within = [&](int margin) {
            const std::array<int, 3> at{voxel % 16, voxel / 16 % 16, voxel / 256};
            return std::ranges::all_of(at, [=](int i) { return i >= margin && i < 16 - margin; });
        };
        text += is_within(2) && !is_within(6) ? '\1' : '\0';
    }
    write(folder_ / "hollow.vol", text);
    const auto voids = [&](const Arguments& more) {
        Arguments arguments{"axis", "hollow.vol", "-o", "out.ply", "--delta", "0.05", "--stats", "-"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return Json::parse(run(arguments).out)["results"][0]["solid"]["voids"];
    };
    EXPECT_EQ(voids({}), 1);
    EXPECT_EQ(voids({"--fill-voids"}), 0);
}

TEST_F(CommandLine, TakesImages) {
    write(folder_ / "labels.vol", label_image());
    const Outcome one =
        run({"axis", "labels.vol", "--label", "2", "-o", "{name}.ply", "--delta", "0.05", "--stats", "-"});
    EXPECT_EQ(one.status, 0) << one.err;
    EXPECT_EQ(one.err, "");
    const Json result = Json::parse(one.out)["results"][0];
    EXPECT_EQ(result["image"]["sizes"], Json({16, 12, 10}));
    EXPECT_EQ(result["image"]["labels"].size(), 3u);
    EXPECT_EQ(result["image"]["labels"][1]["voxels"], 6 * 8 * 6);
    EXPECT_EQ(result["solid"], (Json{{"components", 1}, {"euler", 1}, {"tunnels", 0}, {"voids", 0}}));
    EXPECT_EQ(result["axes"][0]["dual_complex"]["topology"], result["solid"]);

    const Outcome each = run({"axis", "labels.vol", "--each-label", "-o", "results/", "--delta", "0.05"});
    EXPECT_EQ(each.status, 0) << each.err;
    for (const std::string label : {"1", "2", "7"}) {
        EXPECT_TRUE(fs::exists(folder_ / "results" / ("labels-label" + label + "-axis.ply"))) << label;
    }

    const Outcome objects = run({"axis", "box.off", "--each-object", "-o", "{name}.ply", "--stats", "-"});
    EXPECT_EQ(objects.status, 0) << objects.err;
    EXPECT_TRUE(fs::exists(folder_ / "box-object1.ply"));
    const Outcome one_object = run({"axis", "box.off", "--object", "1", "-o", "one.ply", "-q"});
    EXPECT_EQ(one_object.status, 0) << one_object.err;
    EXPECT_EQ(content(folder_ / "box-object1.ply"), content(folder_ / "one.ply"));
    const Outcome parts_of_image = run({"axis", "labels.vol", "--each-object", "-o", "{name}.ply"});
    EXPECT_EQ(parts_of_image.status, 2);
    EXPECT_TRUE(contains(parts_of_image.err, "--each-object is for inputs of kind mesh")) << parts_of_image.err;

    write(folder_ / "large.inr", large_labels());
    EXPECT_EQ(run({"axis", "large.inr", "--each-label", "-o", "{name}.ply", "--delta", "0.1"}).status, 0);
    for (const std::string label : {"16777215", "16777216"}) {
        EXPECT_TRUE(fs::exists(folder_ / ("large-label" + label + ".ply"))) << label;
    }
    write(folder_ / "grey.pgm3d", "P2-3D\n2 2 2\n255\n0 0 0 0 0 0 0 0\n");
    const Outcome no_labels = run({"axis", "grey.pgm3d", "--each-label", "-o", "{name}.ply"});
    EXPECT_EQ(no_labels.status, 2);
    EXPECT_TRUE(contains(no_labels.err, "the image has no labels")) << no_labels.err;

    const Outcome closed = run({"balls", "labels.vol", "--nonzero", "-o", "out.ply", "--delta", "0.05"});
    EXPECT_EQ(closed.status, 0);
    EXPECT_TRUE(contains(closed.err, "closed at the border of the image, where it has 1 voxel")) << closed.err;

    const Outcome unclear = run({"axis", "labels.vol", "-o", "out.ply"});
    EXPECT_EQ(unclear.status, 2);
    EXPECT_TRUE(contains(unclear.err, "values are 0 ... 7: choose an iso value, labels")) << unclear.err;
    const Outcome absent = run({"axis", "labels.vol", "--label", "1,5", "-o", "out.ply"});
    EXPECT_EQ(absent.status, 4);
    EXPECT_TRUE(contains(absent.err, "no voxel has the label 5")) << absent.err;
    const Outcome high = run({"axis", "labels.vol", "--iso", "8", "-o", "out.ply"});
    EXPECT_EQ(high.status, 4);
    EXPECT_TRUE(contains(high.err, "no voxel is above 8: the values are 0 ... 7")) << high.err;
    EXPECT_EQ(run({"axis", "box.off", "--as", "image", "-o", "out.ply"}).status, 3);

    const Outcome info = run({"info", "labels.vol"});
    EXPECT_TRUE(contains(info.out, "16 x 12 x 10 voxels of 1 x 1 x 1")) << info.out;
    EXPECT_TRUE(contains(info.out, "2 (288 voxels)")) << info.out;
}

TEST_F(CommandLine, TakesFunctions) {
    const Arguments bounds{"--bounds", "-2,-2,-1,2,2,1", "-o", "{name}.ply", "--delta", "0.04"};
    const auto implicit = [&](const std::string& expression) {
        Arguments arguments{"axis", "--implicit", expression};
        arguments.insert(arguments.end(), bounds.begin(), bounds.end());
        return run(arguments);
    };
    const Outcome torus = implicit("(sqrt(x^2+y^2)-1)^2+z^2-0.1");
    EXPECT_EQ(torus.status, 0) << torus.err;
    EXPECT_TRUE(fs::exists(folder_ / "implicit.ply"));
    EXPECT_TRUE(contains(torus.out, "function    (sqrt(x^2+y^2)-1)^2+z^2-0.1")) << torus.out;
    EXPECT_TRUE(contains(torus.out, "union (dual)               1       0        1      0")) << torus.out;
    struct Wrong {
        std::string expression;
        int status;
        std::string message;
    };
    for (const auto& [expression, status, message] :
         {Wrong{"x+y*", 2, "column 5"}, Wrong{"x+w", 2, "column 3"}, Wrong{"sin(x", 2, "column 6"},
          Wrong{"x,y", 2, "comma"}, Wrong{"sqrt(x)", 4, "not a number at (-2, -2, -1)"},
          Wrong{"x+3", 4, "nowhere negative"}, Wrong{"x^2+y^2+z^2-2", 4, "the bounds cut the solid at ("},
          Wrong{"0.5-x**2-y**2-z**2", 4, "change its sign"}, Wrong{"x=-1", 2, "column 2: an assignment"},
          Wrong{"(x<=1)*(y==0)-x=1", 2, "column 16: an assignment"}}) {
        const Outcome outcome = implicit(expression);
        EXPECT_EQ(outcome.status, status) << expression;
        EXPECT_TRUE(contains(outcome.err, message)) << outcome.err;
    }
}

TEST_F(CommandLine, TakesFunctionsAsOthersWriteThem) {
    const auto samples = [&](const std::string& expression, bool is_clipped) {
        Arguments arguments{"axis",    "--implicit", expression, "--bounds", "-2,-2,-1,2,2,1", "-o", "a.ply",
                            "--delta", "0.04",       "--stats",  "-"};
        if (is_clipped) {
            arguments.push_back("--clip");
        }
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 0) << expression << outcome.err;
        return outcome.status == 0 ? Json::parse(outcome.out)["results"][0]["samples"] : Json();
    };
    const Json expected = samples("x^2+y^2+z^2-0.5", false);
    for (const std::string expression : {"x**2+y**2+z**2-0.5", "pow(x,2)+pow(y, 2)+z ** 2-0.5",
                                         "fmod(x^2+y^2+z^2,100)-0.5", "max(abs(x)^2+y^2+z^2-0.5, min(-pi, -1))",
                                         "hypot(x,y)^2+z^2-0.5+floor(0.5)-ceil(-0.5)", "mod(-20+x^2+y^2+z^2,20)-0.5"}) {
        EXPECT_EQ(samples(expression, false), expected) << expression;
    }
    // A cylinder without ends is closed.
    EXPECT_TRUE(samples("x^2+y^2-0.5", true).is_number());
}

TEST_F(CommandLine, TakesBallsAsASolid) {
    write(folder_ / "two.balls", "0 0 0 1\n1.2 0 0 0.8\n");
    const Outcome outcome = run({"axis", "two.balls", "-o", "out.ply", "--delta", "0.05", "--stats", "-"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(Json::parse(outcome.out)["results"][0]["union"]["distinct"], 2);
}

TEST_F(CommandLine, SpheresOfASolid) {
    for (const std::string format : {"json", "yaml", "csv", "srdf", "urdf", "ply"}) {
        const Outcome outcome = run({"spheres", "box.off", "--count", "2", "--delta", "0.05", "-o", "few." + format});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_TRUE(contains(outcome.out, "coverage")) << outcome.out;
    }
    const Json spheres = Json::parse(content(folder_ / "few.json"))["links"][0]["spheres"];
    ASSERT_EQ(spheres.size(), 2U);
    // Two balls that cover a cube stick out no less than one through its corners does.
    const double error = 0.5 * std::sqrt(3.0) - 0.5;
    for (const Json& sphere : spheres) {
        const auto [x, y, z] = sphere["center"].get<std::array<double, 3>>();
        const double depth = std::min({x, y, z, 1.0 - x, 1.0 - y, 1.0 - z});
        EXPECT_LE(sphere["radius"].get<double>() - depth, error + 1e-3);
    }
    for (int corner = 0; corner < 8; ++corner) {
        double nearest = 1.0;
        for (const Json& sphere : spheres) {
            const auto [x, y, z] = sphere["center"].get<std::array<double, 3>>();
            nearest = std::min(nearest, std::hypot(x - (corner & 1), y - (corner >> 1 & 1), z - (corner >> 2)) -
                                            sphere["radius"].get<double>());
        }
        EXPECT_LE(nearest, 0.0) << corner;
    }
    const Json statistics = Json::parse(content(folder_ / "few.json"))["links"][0]["statistics"];
    EXPECT_NEAR(statistics["error"].get<double>(), error, 1e-3);
    EXPECT_EQ(scaleaxis::read_balls(folder_ / "few.ply").size(), 2U);
    EXPECT_TRUE(content(folder_ / "few.yaml").starts_with("collision_spheres:\n  \"box\":\n    - center: ["));
    EXPECT_TRUE(contains(content(folder_ / "few.srdf"), "<link_sphere_approximation link=\"box\">"));
    expect_error_line(run({"spheres", "box.off", "-o", "few.json"}), "--count, --total or --error");
    expect_error_line(run({"spheres", "box.off", "-o", "few.json", "--count", "2", "--effort", "0"}), "0.01 ... 1000");
    expect_error_line(run({"spheres", "box.off", "--count", "2", "-o", "few.doc"}), ".yaml");
}

TEST_F(CommandLine, TellsWhichNumbersAreRight) {
    const auto error = [&](const Arguments& arguments) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2);
        EXPECT_FALSE(contains(outcome.err, "--help")) << outcome.err;
        return outcome.err;
    };
    const Arguments axis{"axis", "box.off", "-o", "x.ply"};
    const auto with = [&](Arguments more) {
        more.insert(more.begin(), axis.begin(), axis.end());
        return more;
    };
    EXPECT_TRUE(contains(error(with({"--scale", "11"})), "11 is not in the range 1 ... 10"));
    EXPECT_TRUE(contains(error(with({"--vertices", "0"})), "0 is not a whole number in the range 1 ... 1e+08"));
    EXPECT_TRUE(contains(error(with({"--threads", "1.5"})), "1.5 is not a whole number in the range 0 ... 1024"));
    EXPECT_TRUE(contains(error({"spheres", "box.off", "-o", "x.ply", "--count", "many"}), "1 ... 100000"));
    EXPECT_TRUE(contains(run({"axis", "--nonsense"}).err, "; see scaleaxis --help"));
    EXPECT_FALSE(contains(run({"axis", "--help"}).out, "{false}"));
}

TEST_F(CommandLine, CompactAxesSayWhyTheyKeepMoreVertices) {
    const Outcome few =
        run({"axis", "box.off", "-o", "few.ply", "--delta", "0.05", "--vertices", "2", "--error", "0.001", "-q"});
    EXPECT_EQ(few.status, 0);
    EXPECT_TRUE(contains(few.err, "vertices are left")) << few.err;
    EXPECT_TRUE(contains(few.err, "not 2 as asked for")) << few.err;
    const Outcome enough = run({"axis", "box.off", "-o", "few.ply", "--delta", "0.05", "--vertices", "5000", "-q"});
    EXPECT_EQ(enough.err, "");
    ASSERT_EQ(run({"axis", "box.off", "-o", "axis.ply", "--delta", "0.05", "-q"}).status, 0);
    const Outcome stored = run({"simplify", "axis.ply", "-o", "few.ply", "--vertices", "2", "-q"});
    EXPECT_TRUE(contains(stored.err, "would change the topology")) << stored.err;
}

TEST_F(CommandLine, ThicknessRefusesAResolutionWithoutAnImage) {
    expect_error_line(run({"thickness", "box.off", "-o", "x.ply", "--resolution", "50"}), "--image");
}

TEST_F(CommandLine, SpheresOfARobot) {
    const std::string robot = SCALEAXIS_SOURCE_DIR "/examples/robot/gripper.urdf";
    expect_error_line(run({"spheres", robot, "--count", "3", "-o", "few.urdf", "--label", "1"}),
                      "--label has no effect on a robot");
    const Outcome outcome = run({"spheres", robot, "--count", "3", "--delta", "0.05", "-o", "few.urdf"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const std::string urdf = content(folder_ / "few.urdf");
    EXPECT_FALSE(contains(urdf, "<mesh") || contains(urdf, "<box") || contains(urdf, "<cylinder"));
    EXPECT_TRUE(contains(urdf, "<joint name=\"slide\""));
    // The one that the arm had stays.
    EXPECT_TRUE(contains(urdf, "<sphere radius=\"0.05\" />"));
    std::size_t count = 0;
    for (std::size_t at = 0; (at = urdf.find("<sphere", at)) != std::string::npos; ++at) {
        ++count;
    }
    EXPECT_EQ(count, 9U);
    // What it wrote is a robot of spheres alone: they come back as they are.
    EXPECT_EQ(run({"spheres", "few.urdf", "--count", "3", "-o", "again.csv", "--quiet"}).status, 0);
    const std::string csv = content(folder_ / "again.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 10);

    write(folder_ / "bad.urdf",
          "<robot name='a'><link name='b'><collision><geometry><mesh filename='package://p/c.stl'/>"
          "</geometry></collision></link></robot>");
    const Outcome bad = run({"spheres", "bad.urdf", "--count", "3", "-o", "x.urdf"});
    EXPECT_EQ(bad.status, 3);
    expect_error_line(bad, "name the folder of its package");
    write(folder_ / "torn.urdf", "<robot name='a'>\n<link");
    expect_error_line(run({"spheres", "torn.urdf", "--count", "3", "-o", "x.urdf"}),
                      "torn.urdf: line 2: this is no XML");
    std::string deep = "<robot>";
    for (int i = 0; i < 100000; ++i) {
        deep += "<a>";
    }
    for (int i = 0; i < 100000; ++i) {
        deep += "</a>";
    }
    write(folder_ / "deep.urdf", deep + "</robot>");
    expect_error_line(run({"spheres", "deep.urdf", "--count", "3", "-o", "x.urdf"}), "nested more than 1000 deep");
}

TEST_F(CommandLine, SpheresOfARobotForPlanners) {
    const std::string robot = SCALEAXIS_SOURCE_DIR "/examples/robot/gripper.urdf";
    const Arguments quick{"--delta", "0.05", "--effort", "0.1", "-q"};
    const auto with = [&](Arguments more) {
        more.insert(more.begin(), {"spheres", robot});
        more.insert(more.end(), quick.begin(), quick.end());
        return run(more);
    };
    const Outcome shared = with({"--total", "9", "--clip-plane", "palm:z:0", "-o", "few.json"});
    EXPECT_EQ(shared.status, 0) << shared.err;
    const Json document = Json::parse(content(folder_ / "few.json"));
    std::size_t count = 0;
    for (const Json& link : document["links"]) {
        count += link["spheres"].size();
        for (const Json& sphere : link["spheres"]) {
            if (link["link"].get<std::string>() == "palm") {
                EXPECT_GE(sphere["center"][2].get<double>(), sphere["radius"].get<double>() - 1e-9);
            }
        }
    }
    EXPECT_EQ(count, 9U);
    EXPECT_EQ(document["ignored_pairs"].size(), 2U);

    EXPECT_EQ(with({"--count", "2", "--output-format", "curobo", "-o", "few.yml"}).status, 0);
    EXPECT_TRUE(content(folder_ / "few.yml").starts_with("\"robot_cfg\":\n  \"kinematics\":\n"));
    EXPECT_EQ(with({"--count", "2", "--output-format", "ballpark", "-o", "all/"}).status, 0);
    EXPECT_TRUE(contains(content(folder_ / "all/gripper-spheres.json"), "\"ignore_pairs\""));
    EXPECT_EQ(with({"--count", "2", "--output-format", "vamp", "--large", "2", "-o", "all/"}).status, 0);
    expect_error_line(with({"--count", "2", "--large", "2", "-o", "few.yml"}), "--large is for --output-format vamp");
    for (const std::string file : {"_spherized.urdf", "_spherized_1.urdf", "_spherized.srdf", ".json"}) {
        EXPECT_TRUE(fs::exists(folder_ / ("all/gripper" + file))) << file;
    }
    EXPECT_EQ(with({"--count", "2", "-o", "few.srdf"}).status, 0);
    EXPECT_TRUE(contains(content(folder_ / "few.srdf"),
                         "<disable_collisions link1=\"arm\" link2=\"palm\" reason=\"Adjacent\"/>"));

    expect_error_line(with({"--total", "2", "-o", "x.json"}), "too few");
    expect_error_line(with({"--total", "9", "--count", "2", "-o", "x.json"}), "neither --count nor --error");
    expect_error_line(with({"--count", "2", "--clip-plane", "z:0", "-o", "x.json"}), "which link");
    expect_error_line(with({"--count", "2", "--clip-plane", "palm:up:0", "-o", "x.json"}), "LINK:AXIS:OFFSET");
    expect_error_line(with({"--count", "2", "--rest", "slide", "-o", "x.json"}), "JOINT=POSITION");
    expect_error_line(with({"--count", "2", "--output-format", "vamp", "-o", "-"}), "several files");
    expect_error_line(run({"spheres", "box.off", "--total", "9", "-o", "x.json"}), "is for robots");
    expect_error_line(run({"spheres", "box.off", "--count", "2", "--output-format", "curobo", "-o", "x.yml"}),
                      "is for robots");
    const Outcome box = run({"spheres", "box.off", "--count", "9", "--clip-plane", "0,0,1:0.5", "--delta", "0.05", "-o",
                             "half.xyzr", "-q"});
    EXPECT_EQ(box.status, 0) << box.err;
    for (const scaleaxis::Ball& ball : scaleaxis::read_balls(folder_ / "half.xyzr")) {
        EXPECT_GE(ball.center.z - ball.radius, 0.5 - 1e-9);
    }
}

TEST_F(CommandLine, XacroIsExpandedByItsProgram) {
    const std::string path = std::getenv("PATH");
    fs::create_directory(folder_ / "bin");
    setenv("PATH", (folder_ / "bin").c_str(), 1);
    write(folder_ / "box.urdf.xacro", "<robot/>");
    const Arguments command{"spheres", "box.urdf.xacro", "--count", "2",       "--xacro", "size:=1",
                            "--delta", "0.05",           "-o",      "few.csv", "-q"};
    expect_error_line(run(command), "pip install xacro");
    const auto install = [&](const std::string& script) {
        write(folder_ / "bin/xacro", "#!/bin/sh\n" + script);
        fs::permissions(folder_ / "bin/xacro", fs::perms::owner_all);
    };
    install("echo noise >&2\necho 'no property wide' >&2\nexit 2\n");
    expect_error_line(run(command), "box.urdf.xacro: xacro does not expand it: no property wide");
    install(
        "[ \"$2\" = size:=1 ] || exit 1\ncat <<END\n<robot name='r'><link name='l'><collision><geometry>"
        "<box size='1 1 2'/></geometry></collision></link></robot>\nEND\n");
    setenv("PATH", ((folder_ / "bin").string() + ":" + path).c_str(), 1);
    const Outcome outcome = run(command);
    setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(content(folder_ / "few.csv").starts_with("link,x,y,z,radius\nl,"));
}

TEST_F(CommandLine, WritesTheAxisAndTellsAboutIt) {
    const Outcome outcome = run({"axis", "box.off", "-o", "out.ply", "--delta", "0.05"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    for (const std::string part : {"box.off", "8 vertices, 12 triangles", "genus 0", "samples", "balls", "hidden",
                                   "boundary vert", "sheets", "out.ply", "input solid", "union (dual)", "medial axis",
                                   "filtered", "cleaned", "agreement", " s, peak memory"}) {
        EXPECT_TRUE(contains(outcome.out, part)) << part << "\n" << outcome.out;
    }
    EXPECT_EQ(files(), (std::set<std::string>{"box.off", "out.ply"}));
    EXPECT_TRUE(content(folder_ / "out.ply").starts_with("ply\n"));
}

TEST_F(CommandLine, IsSilentWhenAskedToBe) {
    const Outcome outcome = run({"axis", "box.off", "-o", "out.ma", "--delta", "0.05", "-q"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.out + outcome.err, "");
    EXPECT_EQ(files(), (std::set<std::string>{"box.off", "out.ma"}));
}

TEST_F(CommandLine, TellsTheStagesOnStderrWhenAskedTo) {
    const Outcome outcome = run({"axis", "box.off", "-o", "out.ply", "--delta", "0.05", "-v"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(contains(outcome.err, "box.off: sampling")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "box.off: filter")) << outcome.err;
}

TEST_F(CommandLine, StatisticsAreCompleteAndTrue) {
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome =
        run({"axis", "box.off", "-o", "out.ma", "--delta", "0.05", "--balls", "out.balls", "--stats", "-"});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Json document = Json::parse(outcome.out);
    EXPECT_EQ(document["schema"], "scaleaxis.axis/2");
    EXPECT_EQ(document["options"]["delta"], 0.05);
    EXPECT_TRUE(document["options"]["absolute_delta"].is_null());
    ASSERT_EQ(document["results"].size(), 1u);

    const Json& result = document["results"][0];
    EXPECT_EQ(result["mesh"]["vertices"], 8);
    EXPECT_EQ(result["mesh"]["triangles"], 12);
    EXPECT_EQ(result["mesh"]["components"], 1);
    EXPECT_EQ(result["mesh"]["genus"], 0);
    EXPECT_EQ(result["mesh"]["euler"], 2);
    EXPECT_NEAR(result["mesh"]["volume"].get<double>(), 1.0, 1e-12);
    EXPECT_NEAR(result["diagonal"].get<double>(), std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(result["tolerance"].get<double>(), 0.05 * std::sqrt(3.0), 1e-12);
    EXPECT_EQ(result["solid"]["components"], 1);
    EXPECT_EQ(result["solid"]["euler"], 1);
    EXPECT_EQ(result["warnings"], Json::array());
    for (const std::string key : {"seeds", "rounds", "conflicts", "restricted_facets", "inside_queries"}) {
        EXPECT_TRUE(result["sampling"][key].is_number_integer()) << key;
    }
    EXPECT_GT(result["samples"], 100);

    // The balls that are counted are those in the file.
    const std::string balls = content(folder_ / "out.balls");
    std::istringstream lines(balls);
    int ball_lines = 0;
    for (std::string line; std::getline(lines, line);) {
        ball_lines += !line.empty() && line[0] != '#' ? 1 : 0;
    }
    EXPECT_EQ(result["balls"], ball_lines);

    ASSERT_EQ(result["axes"].size(), 1u);
    const Json& axis = result["axes"][0];
    EXPECT_EQ(axis["scale"], 1.1);
    EXPECT_EQ(axis["file"], "out.ma");
    EXPECT_EQ(axis["balls"], result["balls"]);
    EXPECT_EQ(axis["hidden_balls"].get<int>() + axis["dual_complex"]["vertices"].get<int>(), ball_lines);
    EXPECT_EQ(axis["dual_complex"]["topology"]["components"], 1);
    EXPECT_EQ(axis["dual_complex"]["topology"]["euler"], 1);
    EXPECT_EQ(axis["medial_complex"]["topology"]["euler"], 1);
    EXPECT_EQ(axis["filter"]["topology"]["euler"], 1);
    EXPECT_LT(axis["filter"]["sheets_after"], axis["filter"]["sheets_before"]);
    for (const std::string key : {"boundary_vertices", "cells", "inside_cells", "faces", "edges", "vertices"}) {
        EXPECT_GT(axis["medial_complex"][key], 0) << key;
    }
    EXPECT_EQ(axis["agreement"], (Json{{"solid_and_dual", true},
                                       {"dual_and_medial", true},
                                       {"medial_and_filtered", true},
                                       {"filtered_and_sharp", true},
                                       {"filtered_and_cleaned", true},
                                       {"compact_and_before", nullptr}}));
    EXPECT_EQ(axis["cleaning"]["topology"], axis["filter"]["topology"]);
    EXPECT_NEAR(axis["cleaning"]["thickness"].get<double>(), 0.025 * std::sqrt(3.0), 1e-12);
    EXPECT_EQ(axis["cleaning"]["sheets_before"], axis["sharp_edges"]["sheets"]);
    EXPECT_EQ(axis["result"]["sheets"], 12) << "one to each edge of the cube";
    EXPECT_GE(axis["cleaning"]["sheets_after"], axis["result"]["sheets"]) << "slivers are contracted later";
    std::istringstream head(content(folder_ / "out.ma"));
    int vertices = 0;
    head >> vertices;
    EXPECT_EQ(axis["result"]["balls"], vertices);
    double sum = 0.0;
    for (const Json& costs : {result["costs"], axis["costs"]}) {
        ASSERT_FALSE(costs.empty());
        for (const Json& cost : costs) {
            EXPECT_FALSE(cost["stage"].get<std::string>().empty());
            EXPECT_GT(cost["seconds"].get<double>(), 0.0) << cost["stage"];
            sum += cost["seconds"].get<double>();
            EXPECT_GT(cost["peak_memory"].get<std::int64_t>(), 1 << 20);
        }
    }
    EXPECT_LE(sum, seconds);
}

TEST_F(CommandLine, StatisticsGoToAFileBesideTheSummary) {
    const Outcome outcome = run({"axis", "box.off", "-o", "out.ply", "--delta", "0.1", "--stats", "out.json"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(contains(outcome.out, "agreement"));
    EXPECT_EQ(Json::parse(content(folder_ / "out.json"))["status"], 0);
    EXPECT_EQ(files(), (std::set<std::string>{"box.off", "out.json", "out.ply"}));
}

TEST_F(CommandLine, SeveralScalesGetTheirOwnFiles) {
    const Outcome outcome =
        run({"axis", "box.off", "-o", "out.vtp", "--delta", "0.1", "--scale", "1,1.05,1.5", "--stats", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(files(), (std::set<std::string>{"box.off", "out-s1.vtp", "out-s1.05.vtp", "out-s1.5.vtp"}));
    EXPECT_EQ(Json::parse(outcome.out)["results"][0]["axes"].size(), 3u);
}

TEST_F(CommandLine, SeveralInputsAreNamedInAFolderOrByAPattern) {
    write(folder_ / "other.off", box_off(5, 5, 5, 2));
    fs::create_directory(folder_ / "results");
    ASSERT_EQ(run({"axis", "box.off", "other.off", "-o", "results", "--balls", "results", "--delta", "0.1"}).status, 0);
    EXPECT_EQ(files(),
              (std::set<std::string>{"box.off", "other.off", "results", "results/box-axis.ply", "results/box-balls.ply",
                                     "results/other-axis.ply", "results/other-balls.ply"}));
    ASSERT_EQ(run({"axis", "box.off", "other.off", "-o", "{scale}-{name}.obj", "--delta", "0.1", "-q"}).status, 0);
    EXPECT_TRUE(files().contains("1.1-box.obj"));
    EXPECT_TRUE(files().contains("1.1-other.obj"));
}

TEST_F(CommandLine, GoesOnAfterABadInput) {
    write(folder_ / "sheet.off", box_off(0, 0, 0, 1, 1));
    const Outcome outcome =
        run({"axis", "missing.off", "sheet.off", "box.off", "-o", "{name}.ply", "--delta", "0.1", "--stats", "-"});
    EXPECT_EQ(outcome.status, 4);
    EXPECT_TRUE(contains(outcome.err, "missing.off")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "sheet.off")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "2 of 3 inputs failed")) << outcome.err;
    EXPECT_EQ(files(), (std::set<std::string>{"box.off", "box.ply", "sheet.off"}));
    const Json results = Json::parse(outcome.out)["results"];
    EXPECT_EQ(results[0]["status"], 3);
    EXPECT_EQ(results[1]["status"], 4);
    EXPECT_EQ(results[2]["status"], 0);
    EXPECT_TRUE(results[2]["error"].is_null());
}

TEST_F(CommandLine, SameBytesForAnyNumberOfThreads) {
    for (const std::string threads : {"1", "2"}) {
        ASSERT_EQ(run({"axis", kCat, "-o", threads + ".ply", "--balls", threads + ".balls", "--delta", "0.03",
                       "--threads", threads, "-q"})
                      .status,
                  0);
    }
    EXPECT_EQ(content(folder_ / "1.ply"), content(folder_ / "2.ply"));
    EXPECT_EQ(content(folder_ / "1.balls"), content(folder_ / "2.balls"));
    ASSERT_EQ(run({"axis", kCat, "-o", "3.ply", "--delta", "0.03", "--seed", "7", "-q"}).status, 0);
    EXPECT_NE(content(folder_ / "1.ply"), content(folder_ / "3.ply"));
}

TEST_F(CommandLine, WarnsWhereTheTopologyIsNotThatOfTheSolid) {
    // Growing closes the gap between the boxes.
    write(folder_ / "boxes.obj", two_boxes_obj(0.05));
    const Outcome outcome =
        run({"axis", "boxes.obj", "-o", "out.ply", "--delta", "0.03", "--scale", "1.5", "--stats", "-"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(outcome.err.starts_with("scaleaxis: warning: boxes.obj")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "growing the balls by s = 1.5 changes the topology")) << outcome.err;
    const Json result = Json::parse(outcome.out)["results"][0];
    EXPECT_EQ(result["solid"]["components"], 2);
    const Json gap = result["axes"][0]["closed_gaps"].at(0);
    EXPECT_NEAR(gap["place"][0], 1.025, 0.01);
    EXPECT_NEAR(gap["width"], 0.05, 0.01);
    EXPECT_EQ(result["axes"][0]["dual_complex"]["topology"]["components"], 1);
    EXPECT_EQ(result["axes"][0]["agreement"]["solid_and_dual"], false);
    EXPECT_EQ(result["axes"][0]["agreement"]["dual_and_medial"], true);
    ASSERT_EQ(result["warnings"].size(), 1u);
    EXPECT_EQ(result["warnings"][0]["code"], "axis.growth_topology");
    EXPECT_TRUE(contains(outcome.err, result["warnings"][0]["message"].get<std::string>()));
    EXPECT_TRUE(result["warnings"][0]["index"].is_null());
}

TEST_F(CommandLine, WarnsAboutRepairs) {
    // The last vertex belongs to no triangle.
    std::string text = box_off(0, 0, 0, 1);
    text.replace(text.find("8 12"), 1, "9");
    text.insert(text.find("3 0 2 3"), "7 7 7\n");
    write(folder_ / "isolated.off", text);
    const Outcome outcome = run({"axis", "isolated.off", "-o", "out.ply", "--delta", "0.1", "-q"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(outcome.err.starts_with("scaleaxis: warning: isolated.off: 1 ")) << outcome.err;
    EXPECT_EQ(outcome.out, "");
}

TEST_F(CommandLine, KeepsAllSheetsWithoutTheFilter) {
    const Outcome outcome = run({"axis", "box.off", "-o", "out.ply", "--delta", "0.05", "--no-filter", "--stats", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Json filter = Json::parse(outcome.out)["results"][0]["axes"][0]["filter"];
    EXPECT_EQ(filter["sheets_before"], filter["sheets_after"]);
    EXPECT_EQ(filter["faces_removed"], 0);
}

TEST_F(CommandLine, AnInterruptEndsTheProgramAndLeavesNoFile) {
    for (const std::string stage : {"sampling", "medial axis"}) {
        for (const int signal : {SIGINT, SIGTERM}) {
            SCOPED_TRACE(stage + ", signal " + std::to_string(signal));
            const Outcome outcome =
                interrupt({"axis", kCat, "-o", "new/out.ply", "--delta", "0.004", "--stats", "out.json"},
                          "cat.obj: " + stage, signal);
            EXPECT_EQ(outcome.status, 5) << outcome.err;
            EXPECT_TRUE(contains(outcome.err, "scaleaxis: error: cancelled")) << outcome.err;
            EXPECT_EQ(outcome.out, "");
            EXPECT_EQ(files(), (std::set<std::string>{"box.off", "new"}));
        }
    }
}

TEST_F(CommandLine, AnInterruptEndsTheWaitForAPipeAndLeavesNoCopy) {
    mkfifo((folder_ / "pipe").c_str(), 0600);
    const int writer = open((folder_ / "pipe").c_str(), O_RDWR);  // it brings little, and does not end
    ASSERT_EQ(::write(writer, "OFF\n", 4), 4);
    setenv("TMPDIR", folder_.c_str(), 1);
    for (const bool is_killed : {false, true}) {  // by a second signal, as `timeout` sends it
        const pid_t child = start({"info", "pipe"});
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (files().size() < 3 && std::chrono::steady_clock::now() < deadline) {  // until there is a copy
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        kill(child, SIGINT);
        if (is_killed) {
            kill(child, SIGTERM);
        }
        const Outcome outcome = wait_for(child);
        if (!is_killed) {
            EXPECT_EQ(outcome.status, 5) << outcome.err;
            expect_error_line(outcome, "cancelled");
        }
        EXPECT_EQ(files(), (std::set<std::string>{"box.off", "pipe"}));
    }
    unsetenv("TMPDIR");
    close(writer);
}

TEST_F(CommandLine, ReadsPipes) {
    for (const std::string name : {"/dev/stdin", "-"}) {
        const Outcome outcome =
            run_with_input({"axis", name, "-o", "{name}.ply", "--delta", "0.1", "--stats", "-"}, box_off(0, 0, 0, 1));
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(Json::parse(outcome.out)["results"][0]["input"], name);
        EXPECT_TRUE(files().contains("stdin.ply"));
    }
    EXPECT_EQ(run({"axis", "box.off", "-o", "file.ply", "--delta", "0.1", "-q"}).status, 0);
    EXPECT_EQ(content(folder_ / "stdin.ply"), content(folder_ / "file.ply"));

    EXPECT_EQ(run_with_input({"medial", "-", "-o", "out.ma"}, "0 0 0 1\n1 0 0 1\n").status, 0);
    // A triangle beside boxes is left out, but the spheres are measured at it, too: a pipe is read once.
    const Outcome spheres =
        run_with_input({"spheres", "-", "--format", "obj", "--count", "2", "--delta", "0.1", "-o", "out.csv"},
                       two_boxes_obj(1.0) + "v 0 0 9\nv 1 0 9\nv 0 1 9\nf 17 18 19\n");
    EXPECT_EQ(spheres.status, 0) << spheres.err;
    EXPECT_TRUE(contains(spheres.err, "left out")) << spheres.err;
    EXPECT_FALSE(contains(spheres.out, "100.0 % of the surface")) << spheres.out;
    // A folder or a list may stand for one file.
    std::filesystem::create_directory(folder_ / "one");
    std::filesystem::copy(folder_ / "box.off", folder_ / "one" / "box.off");
    std::ofstream(folder_ / "list.txt") << "box.off\n";
    for (const std::string input : {"one", "@list.txt"}) {
        EXPECT_EQ(run({"spheres", input, "--count", "2", "-o", "few.json"}).status, 0) << input;
        EXPECT_EQ(run({"filtration", input, "-o", "nested.ply"}).status, 0) << input;
    }
    // As a solid, and as an axis that is there already: what it is has to be known first.
    const std::string axis = content(folder_ / "file.ply");
    for (const Arguments& command : {Arguments{"skeleton", "-", "-o", "out.swc"},
                                     {"midsurface", "-", "-o", "out.ply", "--angle", "20"},
                                     {"thickness", "-", "-o", "out.ply", "--edge", "0.2"},
                                     {"filtration", "-", "-o", "out.ply"},
                                     {"spheres", "-", "-o", "out.ply", "--count", "2"}}) {
        SCOPED_TRACE(command[0]);
        const Outcome of_solid = run_with_input(command, box_off(0, 0, 0, 1));
        EXPECT_EQ(of_solid.status, 0) << of_solid.err;
        EXPECT_EQ(run_with_input(command, axis).status, 0);
        Arguments with_option = command;
        with_option.insert(with_option.end(), {"--mask-smoothing", "1"});
        expect_error_line(run_with_input(with_option, axis), "--mask-smoothing has no effect on an axis");
    }
    EXPECT_EQ(run_with_input({"info", "-"}, "").status, 3);
    const Outcome torn = run_with_input({"info", "/dev/stdin"}, box_off(0, 0, 0, 1).substr(0, 60));
    EXPECT_EQ(torn.status, 3);
    expect_error_line(torn, "/dev/stdin");
}

// Bytes go through pipes as they are, and nothing else goes with them.
TEST_F(CommandLine, WritesToStdout) {
    const Arguments more{"--delta", "0.1"};
    const auto with = [&](Arguments arguments) {
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    ASSERT_EQ(run(with({"axis", "box.off", "-o", "file.ply", "--balls", "file.balls"})).status, 0);
    for (const std::string name : {"-", "/dev/stdout"}) {
        const Outcome axis =
            run_with_input(with({"axis", "-", "-o", name, "--stats", "axis.json"}), box_off(0, 0, 0, 1));
        EXPECT_EQ(axis.status, 0) << axis.err;
        EXPECT_EQ(axis.out, content(folder_ / "file.ply"));
        EXPECT_EQ(Json::parse(content(folder_ / "axis.json"))["results"][0]["axes"][0]["file"], "/dev/stdout");
    }
    ASSERT_EQ(run(with({"axis", "box.off", "-o", "file.vtp"})).status, 0);
    EXPECT_EQ(run(with({"axis", "box.off", "-o", "-", "--output-format", "vtp"})).out, content(folder_ / "file.vtp"));
    EXPECT_EQ(run(with({"axis", "box.off", "-o", "strange.name", "--output-format", "vtp", "-q"})).status, 0);
    EXPECT_EQ(content(folder_ / "strange.name"), content(folder_ / "file.vtp"));
    EXPECT_EQ(run(with({"axis", "box.off", "-o", "results/", "--output-format", "vtp", "-q"})).status, 0);
    EXPECT_EQ(content(folder_ / "results" / "box-axis.vtp"), content(folder_ / "file.vtp"));

    const Outcome balls = run(with({"balls", "box.off", "-o", "-", "--output-format", "balls"}));
    EXPECT_EQ(balls.out, content(folder_ / "file.balls"));
    EXPECT_TRUE(run_with_input({"mesh", "-", "-o", "-", "--format", "balls"}, balls.out).out.starts_with("ply\n"));
    EXPECT_TRUE(run_with_input({"medial", "-", "-o", "-", "--output-format", "ma"}, "0 0 0 1\n1 0 0 1\n")
                    .out.starts_with("2 1 0\n"));
    const Outcome field = run_with_input({"sample-field", "-", "-o", "-", "--resolution", "16"}, "0 0 0 1\n1 0 0 1\n");
    EXPECT_TRUE(field.out.starts_with("NRRD")) << field.err;

    for (const Arguments& arguments :
         {with({"axis", "box.off", "-o", "-", "--stats", "-"}), with({"axis", "box.off", "-o", "-", "--balls", "-"}),
          with({"axis", "box.off", "-o", "-", "--scale", "1,2"})}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2);
        expect_error_line(outcome, "would both be written to /dev/stdout");
    }
    const Outcome unknown = run(with({"axis", "box.off", "-o", "-", "--output-format", "stl"}));
    EXPECT_EQ(unknown.status, 2);
    expect_error_line(unknown, "the format has to be one of .ply, .glb, .obj, .ma, .vtp");
}

TEST_F(CommandLine, NamesOfResultsMayBeAsLongAsNamesOfFiles) {
    constexpr std::size_t kLongest = 255;
    const std::string longest(kLongest - std::string("-axis.ply").size(), 'x');
    write(folder_ / (longest + ".off"), content(folder_ / "box.off"));
    const Outcome outcome = run({"axis", longest + ".off", "-o", "out/", "--delta", "0.2", "-q"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(files(), (std::set<std::string>{"box.off", longest + ".off", "out", "out/" + longest + "-axis.ply"}));
    // Told before the work begins.
    expect_error_line(run({"axis", "missing.off", "-o", longest + "x-axis.ply"}), "File name too long");
}

TEST_F(CommandLine, WhatIsWrongWithAModelIsToldWithItsName) {
    write(folder_ / "far.off", box_off(1e12, 0, 0, 1));
    for (const Arguments& arguments : {Arguments{"axis", "-o", "a.ply"}, Arguments{"balls", "-o", "a.ply"},
                                       Arguments{"filtration", "-o", "a.ply"}, Arguments{"sizes", "-o", "a.pos"},
                                       Arguments{"walls", "--min-wall", "1"}, Arguments{"thickness", "-o", "a.ply"},
                                       Arguments{"skeleton", "-o", "a.swc"}, Arguments{"table", "-o", "a.csv"}}) {
        Arguments all = arguments;
        all.emplace_back("far.off");
        const Outcome outcome = run(all);
        EXPECT_EQ(outcome.status, 4);
        EXPECT_TRUE(contains(outcome.err, "error: far.off: too far from the origin")) << outcome.err;
    }
}

TEST_F(CommandLine, AFolderWithoutInputsIsTold) {
    fs::create_directory(folder_ / "empty");
    fs::create_symlink("nowhere.off", folder_ / "empty" / "link.off");
    for (const std::string command : {"axis", "table"}) {
        const Outcome outcome = run({command, "empty", "-o", "out/"});
        EXPECT_EQ(outcome.status, 3);
        expect_error_line(outcome, "empty: cannot read: no file in this folder has the ending of an input");
    }
    fs::copy_file(folder_ / "box.off", folder_ / "empty" / "box.off");
    expect_error_line(run({"thickness", "empty", "-o", "out/"}),
                      "empty: cannot read: it is a folder; name a file in it");
}

TEST_F(CommandLine, NoPageIsMadeOfStatisticsWithoutResults) {
    const Arguments axis{"axis", "box.off",         "-o",      "axis.ply",        "--delta",
                         "0.2",  "--skip-existing", "--stats", "statistics.json", "-q"};
    ASSERT_EQ(run(axis).status, 0);
    ASSERT_EQ(run({"view", "statistics.json", "-o", "page.html", "-q"}).status, 0);
    fs::remove(folder_ / "page.html");
    ASSERT_EQ(run(axis).status, 0);
    const Outcome outcome = run({"view", "statistics.json", "-o", "page.html"});
    EXPECT_EQ(outcome.status, 3);
    expect_error_line(outcome, "statistics.json: there is nothing to show, since each of its inputs was skipped");
    EXPECT_FALSE(fs::exists(folder_ / "page.html"));
}

TEST_F(CommandLine, NoOutputOverwritesAnInputOfAnyOption) {
    ASSERT_EQ(run({"axis", "box.off", "-o", "axis.ply", "--delta", "0.2", "-q"}).status, 0);
    write(folder_ / "shape.off", content(folder_ / "box.off"));
    write(folder_ / "list.json", "box.off\n");
    write(folder_ / "vertices.mesh", "MeshVersionFormatted 2\nDimension 3\nVertices\n1\n0 0 0 0\nEnd\n");
    for (const auto& [arguments, input] : std::vector<std::pair<Arguments, std::string>>{
             {{"axis", "box.off", "-o", "./box.off"}, "box.off"},
             {{"thickness", "axis.ply", "--surface", "shape.off", "--stats", "shape.off"}, "shape.off"},
             {{"sizes", "box.off", "--at", "vertices.mesh", "-o", "a.sol", "--stats", "vertices.mesh"},
              "vertices.mesh"},
             {{"axis", "@list.json", "-o", "a.ply", "--stats", "list.json"}, "list.json"},
             {{"filtration", "box.off", "-o", "a.ply", "--plot", "-", "--stats", "box.off"}, "box.off"},
             {{"info", "box.off", "--repaired", "box.off"}, "box.off"},
             {{"view", "axis.ply", "--shape", "shape.off", "-o", "shape.off"}, "shape.off"}}) {
        SCOPED_TRACE(testing::PrintToString(arguments));
        const std::string before = content(folder_ / input);
        const Outcome outcome = run(arguments);
        EXPECT_NE(outcome.status, 0);
        EXPECT_TRUE(contains(outcome.err, "would overwrite the input")) << outcome.err;
        EXPECT_TRUE(contains(outcome.err, input)) << outcome.err;
        EXPECT_EQ(content(folder_ / input), before);
    }
    const Outcome both = run({"filtration", "box.off", "-o", "a.ply", "--plot", "b.svg", "--stats", "b.svg"});
    expect_error_line(both, "would both be written to b.svg");
}

// A word after an option without a value is an input.
TEST_F(CommandLine, TellsTheInputsWhoseResultsWouldHaveOneName) {
    const Outcome outcome = run({"axis", "box.off", "-o", "axis.ply", "--compact", "0.01", "--delta", "0.1"});
    EXPECT_EQ(outcome.status, 2);
    expect_error_line(outcome, "the results of box.off and 0.01 would both be written to axis.ply: name a folder");
    fs::create_directory(folder_ / "in");
    write(folder_ / "in" / "box.off", content(folder_ / "box.off"));
    write_two_boxes_gltf(folder_ / "boxes.gltf", 1);
    for (const auto& [arguments, message] : std::vector<std::pair<Arguments, std::string>>{
             {{"axis", "box.off", "boxes.gltf", "in/box.off", "boxes.gltf", "-o", "out/"},
              "the results of box.off and in/box.off would both be written to out/box-axis.ply, as both are called "
              "box"},
             {{"axis", "box.off", "box.off", "-o", "out/"}, "name each input and each output once"},
             {{"axis", "box.off", "-o", "out/", "--scale", "1.5,1,1.5"}, "--scale has the same number twice"},
             {{"filtration", "box.off", "-o", "a.ply", "--plot", "a.svg", "--plot", "a.svg"},
              "two results would both be written to a.svg: name each input and each output once"},
             {{"walls", "boxes.gltf", "--each-object", "--min-wall", "1", "-o", "-"},
              "the results of boxes-object1 and boxes-object2 would both be written to /dev/stdout, which takes "
              "one"}}) {
        const Outcome refused = run(arguments);
        EXPECT_EQ(refused.status, 2);
        expect_error_line(refused, message);
    }
}

// What is between two balls belongs to the solid, whether the edge is shorter than their radii or longer.
TEST_F(CommandLine, BallsOfMaAreInterpolatedAlongEdgesOfAnyLength) {
    for (const double length : {0.05, 0.24, 0.25, 0.5}) {
        SCOPED_TRACE(length);
        write(folder_ / "two.ma", "2 1 0\nv 0 0 0 0.25\nv " + std::to_string(length) + " 0 0 0.25\ne 0 1\n");
        ASSERT_EQ(run({"mesh", "two.ma", "-o", "two.off", "--delta", "0.005", "-q"}).status, 0);
        const double volume = Json::parse(run({"info", "two.off", "--json"}).out)["mesh"]["volume"];
        const double expected = std::numbers::pi * 0.0625 * (4.0 / 3.0 * 0.25 + length);
        EXPECT_NEAR(volume, expected, 0.002 * expected);
    }
}

// Six columns, the last of which are colours or a normal; four, which are balls: the name tells where the content
// cannot.
TEST_F(CommandLine, FormatOfAPipeCanBeTold) {
    const std::string counts = "8 12 0\n" + box_off(0, 0, 0, 1).substr(9);
    EXPECT_NE(run_with_input({"info", "-"}, counts).status, 0);
    const Outcome told = run_with_input({"info", "-", "--format", "off"}, counts);
    EXPECT_EQ(told.status, 0) << told.err;
    EXPECT_TRUE(contains(told.out, "12 triangles")) << told.out;
    write(folder_ / "nameless", counts);
    EXPECT_EQ(run({"info", "nameless", "--format", "off"}).status, 0);
    expect_error_line(run({"info", "box.off", "--format", "offf"}), "--format");
    expect_error_line(run({"axis", "--implicit", "x", "--bounds", "0,0,0,1,1,1", "--format", "off", "-o", "a.ply"}),
                      "--format");
    expect_error_line(run({"axis", "-", "-", "-o", "{name}.ply"}), "only once");
}

TEST_F(CommandLine, AFolderStandsForItsFiles) {
    fs::create_directories(folder_ / "models" / "inner");
    write(folder_ / "models" / "b.off", box_off(0, 0, 0, 1));
    write(folder_ / "models" / "a.OFF", box_off(0, 0, 0, 2));
    write(folder_ / "models" / "notes.txt", "no balls");
    write(folder_ / "models" / "other.dat", "nothing");
    write(folder_ / "models" / "inner" / "c.off", box_off(0, 0, 0, 3));
    const Outcome outcome = run({"axis", "models", "box.off", "-o", "out/", "--delta", "0.1", "--stats", "-"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const Json results = Json::parse(outcome.out)["results"];
    ASSERT_EQ(results.size(), 3u);
    EXPECT_EQ(results[0]["input"], "models/a.OFF");
    EXPECT_EQ(results[1]["input"], "models/b.off");
    EXPECT_EQ(results[2]["input"], "box.off");
    expect_error_line(run({"balls", "models", "-o", "a.balls"}), "one input is needed");
}

TEST_F(CommandLine, AListNamesItsInputs) {
    fs::create_directories(folder_ / "lists");
    write(folder_ / "lists" / "a b.off", box_off(0, 0, 0, 2));
    write(folder_ / "lists" / "list.txt", "\xEF\xBB\xBF# models\n\n  a b.off \r\n../box.off\nmissing.off\n");
    const Outcome outcome = run({"axis", "@lists/list.txt", "-o", "out/", "--delta", "0.1", "--stats", "-"});
    EXPECT_EQ(outcome.status, 3);
    EXPECT_TRUE(contains(outcome.err, "lists/missing.off: ")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "(lists/list.txt, line 5)")) << outcome.err;
    EXPECT_TRUE(files().contains("out/a b-axis.ply"));
    EXPECT_TRUE(files().contains("out/box-axis.ply"));
    EXPECT_EQ(Json::parse(outcome.out)["results"].size(), 3u);

    EXPECT_EQ(run_with_input({"axis", "@-", "-o", "piped/", "--delta", "0.1"}, "box.off\n").status, 0);
    EXPECT_TRUE(files().contains("piped/box-axis.ply"));

    write(folder_ / "empty.txt", "# nothing\n");
    const Outcome empty = run({"axis", "@empty.txt", "-o", "out/"});
    EXPECT_EQ(empty.status, 3);
    expect_error_line(empty, "empty.txt: this list names no input");
    write(folder_ / "nested.txt", "box.off\n@lists/list.txt\n");
    expect_error_line(run({"axis", "@nested.txt", "-o", "out/"}), "nested.txt, line 2");
    expect_error_line(run({"axis", "@nowhere.txt", "-o", "out/"}), "nowhere.txt");
}

TEST_F(CommandLine, MakesFoldersOfOutputs) {
    ASSERT_EQ(
        run({"axis", "box.off", "-o", "a/b/", "--balls", "c/balls.ply", "--stats", "d/s.json", "--delta", "0.1", "-q"})
            .status,
        0);
    for (const std::string file : {"a/b/box-axis.ply", "c/balls.ply", "d/s.json"}) {
        EXPECT_TRUE(fs::exists(folder_ / file)) << file;
    }
}

TEST_F(CommandLine, AFileThatGrowsBeyondTheLimitIsAnError) {
    file_size_limit_ = 4096;
    const Outcome outcome = run_process({"axis", "box.off", "-o", "out.ply", "--delta", "0.05", "-q"});
    EXPECT_EQ(outcome.status, 3) << outcome.err;
    expect_error_line(outcome, "out.ply");
    EXPECT_EQ(files(), std::set<std::string>{"box.off"});
}

std::vector<Json> lines_of(const fs::path& file) {
    std::vector<Json> lines;
    std::istringstream text(content(file));
    for (std::string line; std::getline(text, line);) {
        lines.push_back(Json::parse(line, nullptr, false));
    }
    return lines;
}

TEST_F(CommandLine, JsonLinesOutliveTheProgram) {
    write(folder_ / "other.off", box_off(5, 5, 5, 2));
    const Arguments batch{"axis", "box.off", kCat, "-o", "{name}.ply", "--delta", "0.005", "--stats", "s.jsonl"};
    interrupt(batch, "cat.obj: sampling", SIGKILL);
    const std::vector<Json> lines = lines_of(folder_ / "s.jsonl");
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0]["schema"], "scaleaxis.axis/2");
    EXPECT_EQ(lines[1]["input"], "box.off");
    EXPECT_EQ(lines[1]["axes"].size(), 1u);
    // They are all that a page needs.
    ASSERT_EQ(run({"view", "s.jsonl", "-o", "page.html", "-q"}).status, 0);
    EXPECT_EQ(models_of(content(folder_ / "page.html")), 1u);
}

TEST_F(CommandLine, SkipsWhatIsThereAlready) {
    write(folder_ / "other.off", box_off(5, 5, 5, 2));
    const Arguments batch{"axis",         "box.off", "other.off", "-o",      "{name}.ply", "--balls",
                          "{name}.balls", "--delta", "0.1",       "--stats", "s.jsonl",    "--skip-existing"};
    ASSERT_EQ(run(batch).status, 0);
    fs::remove(folder_ / "other.balls");
    const auto first = fs::last_write_time(folder_ / "box.ply");
    const Outcome again = run(batch);
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_TRUE(contains(again.err, "box.off: skipped")) << again.err;
    EXPECT_FALSE(contains(again.err, "other.off: skipped")) << again.err;
    EXPECT_EQ(fs::last_write_time(folder_ / "box.ply"), first);
    EXPECT_TRUE(fs::exists(folder_ / "other.balls"));
    // The lines of both runs: head, two inputs, status.
    const std::vector<Json> lines = lines_of(folder_ / "s.jsonl");
    ASSERT_EQ(lines.size(), 8u);
    EXPECT_EQ(lines[5]["skipped"], true);
    ASSERT_EQ(run({"view", "s.jsonl", "-o", "page.html", "-q"}).status, 0);
    EXPECT_EQ(models_of(content(folder_ / "page.html")), 2u);
}

// A function is asked as often with a page as without: its samples are used for both.
TEST_F(CommandLine, APageTakesNoSecondSampling) {
    const auto stages = [&](const Arguments& more) {
        Arguments arguments{"axis", "--implicit", "x^2+y^2+z^2-1", "--bounds", "-2,-2,-2,2,2,2",
                            "-o",   "out.ply",    "--delta",       "0.05",     "-v"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        std::size_t count = 0;
        for (std::size_t at = outcome.err.find(": sampling"); at != std::string::npos;
             at = outcome.err.find(": sampling", at + 1)) {
            ++count;
        }
        return count;
    };
    EXPECT_EQ(stages({}), 1u);
    EXPECT_EQ(stages({"--view", "page.html"}), 1u);
    EXPECT_EQ(models_of(content(folder_ / "page.html")), 1u);
}

TEST_F(CommandLine, TheProgressBarCountsTheInputs) {
    write(folder_ / "other.off", box_off(5, 5, 5, 2));
    const std::string drawn =
        run_on_terminal({"axis", "box.off", "other.off", "-o", "{name}.ply", "--delta", "0.03", "-q"});
    EXPECT_EQ(drawn, "") << "quiet";
    const std::string bar = run_on_terminal({"axis", "box.off", "other.off", "-o", "{name}.ply", "--delta", "0.03"});
    EXPECT_TRUE(contains(bar, "1 of 2  box.off: sampling")) << bar;
    EXPECT_TRUE(contains(bar, "2 of 2  other.off: sampling")) << bar;
    EXPECT_TRUE(contains(bar, "100 %  2 of 2")) << bar;
    // One fraction for all inputs, which never decreases.
    int last = 0;
    for (std::size_t at = bar.find(" %"); at != std::string::npos; at = bar.find(" %", at + 1)) {
        const std::size_t begin = bar.rfind(' ', at - 1) + 1;
        const int percent = std::stoi(bar.substr(begin, at - begin));
        EXPECT_GE(percent, last);
        last = percent;
    }
}

TEST_F(CommandLine, MedialAxisOfTwoBallsIsTheSegmentBetweenTheirCentres) {
    write(folder_ / "two.balls", "0 0 0 1\n1 0 0 1\n");
    const Outcome outcome = run({"medial", "two.balls", "-o", "out.ma", "--stats", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(content(folder_ / "out.ma").starts_with("2 1 0\n")) << content(folder_ / "out.ma");
    const Json document = Json::parse(outcome.out);
    EXPECT_EQ(document["schema"], "scaleaxis.medial/1");
    EXPECT_EQ(document["balls"], 2);
    EXPECT_TRUE(document["axis"]["filter"].is_null());
    EXPECT_TRUE(document["axis"]["agreement"]["solid_and_dual"].is_null());
    EXPECT_EQ(document["axis"]["agreement"]["dual_and_medial"], true);
    EXPECT_EQ(document["axis"]["result"]["balls"], 2);
}

TEST_F(CommandLine, BallsOfAMeshHaveTheAxisOfTheMesh) {
    ASSERT_EQ(run({"balls", "box.off", "-o", "box.woff", "--delta", "0.05", "-q"}).status, 0);
    ASSERT_EQ(run({"medial", "box.woff", "-o", "balls.ma", "--scale", "1.1", "--angle", "30", "-q"}).status, 0);
    ASSERT_EQ(run({"axis", "box.off", "-o", "mesh.ma", "--delta", "0.05", "--clean", "0", "--no-sharp", "-q"}).status,
              0);
    EXPECT_EQ(content(folder_ / "balls.ma"), content(folder_ / "mesh.ma"));
}

TEST_F(CommandLine, CleansStoredAxes) {
    // Whose axis has something to clean.
    const auto write_axis = [&](std::vector<std::string> options) {
        options.insert(options.begin(), {"axis", "box.off", "--delta", "0.05", "--seed", "4", "-q"});
        ASSERT_EQ(run(options).status, 0);
    };
    write_axis({"-o", "ragged.ply", "--clean", "0"});
    write_axis({"-o", "clean.ply", "--smooth", "0", "--no-center"});
    const Outcome outcome = run({"clean", "ragged.ply", "-o", "stored.ply", "--clean-abs",
                                 std::to_string(0.025 * std::sqrt(3.0)), "--scale", "1.1", "--stats", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Json document = Json::parse(outcome.out);
    EXPECT_EQ(document["schema"], "scaleaxis.clean/1");
    EXPECT_GT(document["cleaning"]["vertices_removed"], 0);
    EXPECT_GT(document["cleaning"]["area_removed"], 0.0);
    const Json clean = Json::parse(run({"info", "clean.ply", "--json"}).out)["axis"];
    EXPECT_EQ(document["after"]["sheets"], clean["sheets"]);
    EXPECT_EQ(document["after"]["topology"], clean["topology"]);
    EXPECT_NEAR(document["after"]["vertices"].get<double>(), clean["vertices"].get<double>(), 3.0);
    // The file says the scale itself, and so does the result; what is given counts more.
    ASSERT_EQ(run({"clean", "ragged.ply", "-o", "told.ply", "--clean", "0.02", "--scale", "1.1", "-q"}).status, 0);
    ASSERT_EQ(run({"clean", "ragged.ply", "-o", "known.ply", "--clean", "0.02", "-q"}).status, 0);
    ASSERT_EQ(run({"clean", "ragged.ply", "-o", "s{scale}.ply", "--clean", "0.02", "-q"}).status, 0);
    EXPECT_EQ(content(folder_ / "s1.1.ply"), content(folder_ / "told.ply"));
    ASSERT_EQ(run({"clean", "ragged.ply", "-o", "other.ply", "--clean", "0.02", "--scale", "2", "-q"}).status, 0);
    EXPECT_EQ(content(folder_ / "known.ply"), content(folder_ / "told.ply"));
    EXPECT_EQ(scaleaxis::read_axis(folder_ / "known.ply").scale, 1.1);
    EXPECT_EQ(scaleaxis::read_axis(folder_ / "other.ply").scale, 2.0);
    const Outcome text = run({"clean", "ragged.ply", "-o", "stored.ma"});
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_TRUE(contains(text.out, "below an erosion thickness of")) << text.out;
    EXPECT_EQ(run({"clean", "ragged.ply", "-o", "x.ply", "--clean", "0.1", "--clean-abs", "1"}).status, 2);
    EXPECT_EQ(run({"clean", "ragged.ply", "-o", "x.ply", "--clean", "0.6"}).status, 2);
    EXPECT_EQ(run({"clean", "box.off", "-o", "x.ply"}).status, 3);
    EXPECT_EQ(run({"axis", "box.off", "-o", "x.ply", "--method", "angle", "--clean", "0.1"}).status, 2);
}

TEST_F(CommandLine, CutsAFiltrationAtAnyScale) {
    const Outcome made = run({"filtration", "box.off", "-o", "nested.ply", "--delta", "0.05", "--plot", "plot.svg",
                              "--plot", "plot.csv", "--largest-scale", "20", "--stats", "-"});
    ASSERT_EQ(made.status, 0) << made.err;
    const Json document = Json::parse(made.out);
    EXPECT_EQ(document["schema"], "scaleaxis.filtration/1");
    EXPECT_EQ(document["levels"].front()["scale"], 1.0);
    EXPECT_GT(document["levels"].front()["area"], document["levels"].back()["area"]);
    EXPECT_GE(document["plateau"]["end"], document["plateau"]["middle"]);
    EXPECT_TRUE(content(folder_ / "plot.svg").starts_with("<svg"));
    const std::string table = content(folder_ / "plot.csv");
    EXPECT_TRUE(table.starts_with("scale,sheets,balls,area,curve_length,volume\n1,")) << table;
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 122);
    EXPECT_NEAR(document["levels"].front()["volume"].get<double>(), 1.0, 0.1);
    EXPECT_EQ(run({"filtration", "box.off", "-o", "x.ply", "--plot", "plot.jpg"}).status, 2);
    const Outcome drawn = run({"filtration", "box.off", "-o", "drawn.ply", "--plot", "plot.png"});
    EXPECT_EQ(drawn.status, 2);
    EXPECT_TRUE(contains(drawn.err, "plots are written to .svg") && contains(drawn.err, "rsvg-convert")) << drawn.err;
    EXPECT_FALSE(fs::exists(folder_ / "drawn.ply"));

    // A level above the largest scale is not known, and the file says which that is.
    const Outcome known = run({"filter", "nested.ply", "-o", "level.ply", "--scale", "20", "-q"});
    EXPECT_EQ(known.status, 0) << known.err;
    EXPECT_EQ(known.err, "");
    const Outcome unknown = run({"filter", "nested.ply", "-o", "level.ply", "--scale", "25", "-q"});
    EXPECT_EQ(unknown.status, 0);
    EXPECT_TRUE(contains(unknown.err, "up to s = 20")) << unknown.err;

    // That of the axis at s = 1 that is stored already is the same.
    ASSERT_EQ(run({"axis", "box.off", "-o", "axis.ply", "--delta", "0.05", "--scale", "1", "-q"}).status, 0);
    ASSERT_EQ(run({"filtration", "axis.ply", "-o", "again.ply", "--largest-scale", "20", "-q"}).status, 0);
    ASSERT_EQ(run({"axis", "box.off", "-o", "grown.ply", "--delta", "0.05", "--scale", "1.2", "-q"}).status, 0);
    const Outcome grown = run({"filtration", "grown.ply", "-o", "x.ply", "-q"});
    EXPECT_EQ(grown.status, 0);
    EXPECT_TRUE(contains(grown.err, "the axis is of s = 1.2")) << grown.err;
    EXPECT_EQ(run({"filter", "axis.ply", "-o", "x.ply", "--scale", "11"}).status, 2);
    expect_error_line(run({"filtration", "axis.ply", "-o", "x.ply", "--label", "1"}), "--label has no effect");
    expect_error_line(run({"skeleton", "axis.ply", "-o", "x.swc", "--iso", "1"}), "--iso has no effect");
    expect_error_line(run({"skeleton", "axis.ply", "-o", "x.swc", "--clean-abs", "1"}), "--clean-abs has no effect");
    expect_error_line(run({"midsurface", "axis.ply", "-o", "x.ply", "--scale", "1.2"}), "--scale has no effect");
    expect_error_line(run({"thickness", "axis.ply", "--sampling", "uniform"}), "--sampling has no effect");
    expect_error_line(run({"thickness", "axis.ply", "--surface", "box.off", "--delta", "0.1"}),
                      "--delta has no effect");
    expect_error_line(run({"spheres", "axis.ply", "-o", "x.ply", "--count", "2", "--label", "1"}), "has no effect");
    EXPECT_EQ(content(folder_ / "nested.ply"), content(folder_ / "again.ply"));

    std::size_t before = scaleaxis::read_axis(folder_ / "axis.ply").faces.size();
    for (const std::string scale : {"1", "1.3", "1.6", "3"}) {
        ASSERT_EQ(run({"filter", "nested.ply", "-o", "level.ply", "--scale", scale, "-q"}).status, 0);
        const scaleaxis::MedialComplex level = scaleaxis::read_axis(folder_ / "level.ply");
        EXPECT_LE(level.faces.size(), before);
        EXPECT_EQ(scaleaxis::topology(level).euler, 1);
        before = level.faces.size();
    }
    EXPECT_LT(before, document["levels"].front()["balls"].get<std::size_t>() / 2);
    // A page of it, at once or later; the levels that it draws are those of the statistics.
    const Outcome page = run({"filtration", "box.off", "-o", "nested.ply", "--delta", "0.05", "--view", "nested.html"});
    ASSERT_EQ(page.status, 0) << page.err;
    EXPECT_TRUE(contains(page.out, "nested.html")) << page.out;
    EXPECT_GT(std::filesystem::file_size(folder_ / "nested.html"), 100000U);
    EXPECT_EQ(run({"view", "nested.ply", "axis.ply", "--shape", "box.off", "-o", "page.html", "-q"}).status, 0);
    EXPECT_EQ(run({"filtration", "box.off", "-o", "nested.ply", "--view", "nested.png"}).status, 2);
    EXPECT_EQ(run({"filtration", "box.off", "-o", "nested.ply", "--plot", "x.html", "--view", "x.html"}).status, 2);
    const Outcome wrong = run({"filtration", "box.off", "-o", "nested.ma"});
    EXPECT_EQ(wrong.status, 2);
    EXPECT_TRUE(contains(wrong.err, ".vtp")) << wrong.err;
}

TEST_F(CommandLine, ChoosesTheScale) {
    const Outcome outcome =
        run({"axis", "box.off", "-o", "out.ply", "--delta", "0.05", "--scale", "auto", "--stats", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Json result = Json::parse(outcome.out)["results"][0];
    EXPECT_EQ(result["axes"][0]["scale"], result["scale_choice"]["middle"]);
    EXPECT_GT(result["scale_choice"]["middle"], 1.0);
    EXPECT_LT(result["scale_choice"]["middle"], 2.0);
    EXPECT_EQ(run({"axis", "box.off", "-o", "out-{scale}.ply", "--scale", "auto"}).status, 2);
    EXPECT_EQ(run({"axis", "box.off", "-o", "out.ply", "--scale", "auto,1.1"}).status, 2);
}

TEST_F(CommandLine, FiltersSmoothsAndRefinesStoredAxes) {
    ASSERT_EQ(
        run({"axis", "box.off", "-o", "box.ply", "--delta", "0.05", "--no-filter", "--clean", "0", "--no-sharp", "-q"})
            .status,
        0);
    ASSERT_EQ(
        run({"axis", "box.off", "-o", "filtered.ply", "--delta", "0.05", "--clean", "0", "--no-sharp", "-q"}).status,
        0);
    const auto axis_in = [&](const std::string& name) { return scaleaxis::read_axis(folder_ / name); };
    const auto document = [&](const Arguments& arguments) {
        Arguments all = arguments;
        all.insert(all.end(), {"--scale", "1.1", "--stats", "-"});
        const Outcome outcome = run(all);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return Json::parse(outcome.out);
    };

    const Json filter = document({"filter", "box.ply", "-o", "stored.ply", "--angle", "30"});
    EXPECT_EQ(filter["schema"], "scaleaxis.filter/1");
    EXPECT_EQ(filter["computed_angles"], 0);
    EXPECT_GT(filter["filter"]["faces_removed"], 0);
    EXPECT_EQ(content(folder_ / "stored.ply"), content(folder_ / "filtered.ply")) << "as the stage does";
    ASSERT_EQ(
        run({"axis", "box.off", "-o", "box.ma", "--delta", "0.05", "--no-filter", "--clean", "0", "--no-sharp", "-q"})
            .status,
        0);
    const Json without = document({"filter", "box.ma", "-o", "rest.ply"});
    EXPECT_EQ(without["computed_angles"], without["before"]["faces"]);
    EXPECT_NEAR(without["filter"]["sheets_after"].get<double>(), filter["filter"]["sheets_after"].get<double>(), 3.0);
    EXPECT_EQ(without["after"]["topology"], without["before"]["topology"]);

    const Json smooth = document({"smooth", "filtered.ply", "-o", "smooth.vtp", "--smooth", "7"});
    EXPECT_EQ(smooth["schema"], "scaleaxis.smooth/1");
    EXPECT_EQ(smooth["smoothing"]["rounds"], 7);
    ASSERT_EQ(run({"smooth", "filtered.ply", "-o", "smooth.ply", "--smooth", "7", "-q"}).status, 0);
    // Large faces are divided first, and what the statistics tell is true of the files.
    const scaleaxis::MedialComplex ragged = axis_in("filtered.ply");
    const scaleaxis::MedialComplex divided =
        scaleaxis::linearized_around_borders(ragged, 0.002 * box_of_balls(ragged).diagonal());
    EXPECT_GT(divided.vertices.size(), ragged.vertices.size());
    const scaleaxis::MedialComplex moved = axis_in("smooth.ply");
    EXPECT_EQ(smooth["before"]["vertices"], ragged.vertices.size());
    EXPECT_EQ(smooth["after"]["vertices"], divided.vertices.size());
    EXPECT_EQ(moved.vertices.size(), divided.vertices.size());
    int count = 0;
    double farthest = 0.0;
    for (std::size_t v = 0; v < ragged.vertices.size(); ++v) {
        count += moved.vertices[v] != ragged.vertices[v] ? 1 : 0;
        farthest = std::max(farthest, distance(moved.vertices[v], ragged.vertices[v]));
    }
    EXPECT_GT(count, 10);
    EXPECT_EQ(smooth["smoothing"]["vertices_moved"], count);
    EXPECT_EQ(smooth["smoothing"]["largest_move"], farthest);
    const Json again = document({"smooth", "smooth.ply", "-o", "again.ply", "--smooth", "7"});
    EXPECT_EQ(again["before"]["vertices"], smooth["after"]["vertices"]);
    EXPECT_EQ(again["after"]["vertices"], again["before"]["vertices"]) << "there are none any more";
    EXPECT_TRUE(contains(content(folder_ / "smooth.vtp"), "Name=\"erosion_thickness\""));

    const Json refine = document({"refine", "filtered.ply", "-o", "dense.ply", "--polygons"});
    EXPECT_EQ(refine["schema"], "scaleaxis.refine/1");
    EXPECT_EQ(refine["meeting_angle"], 150.0);
    EXPECT_GT(refine["after"]["vertices"], refine["before"]["vertices"]);
    EXPECT_EQ(refine["after"]["topology"], refine["before"]["topology"]);
    EXPECT_TRUE(contains(content(folder_ / "dense.ply"), "element edge"));
    EXPECT_EQ(axis_in("dense.ply").sheets, axis_in("filtered.ply").sheets);
    EXPECT_EQ(run({"refine", "filtered.ply", "-o", "x.ply", "--most-vertices", "10"}).status, 4);

    // A medial mesh of another program: a cone between two balls far apart.
    write(folder_ / "cone.ma", "2 1 0\nv 0 0 0 1\nv 4 0 0 0.5\ne 0 1\n");
    const Outcome cone = run({"refine", "cone.ma", "-o", "cone.ply"});
    EXPECT_EQ(cone.status, 0) << cone.err;
    EXPECT_TRUE(contains(cone.out, "cone.ply")) << cone.out;
    EXPECT_EQ(cone.err, "");
    const Outcome coarse = run({"clean", "cone.ma", "-o", "clean.ply"});
    EXPECT_TRUE(contains(coarse.err, "1 of 1 edges")) << coarse.err;
    EXPECT_EQ(run({"clean", "cone.ply", "-o", "clean.ply"}).err, "");
    EXPECT_EQ(run({"filter", "cone.ma", "-o", "kept.ply", "--angle", "80", "-q"}).status, 0);
    EXPECT_EQ(axis_in("kept.ply").edges.size(), 1U);
    const scaleaxis::MedialComplex finer = axis_in("cone.ply");
    EXPECT_GT(finer.vertices.size(), 5U);
    for (std::size_t v = 0; v < finer.vertices.size(); ++v) {
        EXPECT_NEAR(finer.radii[v], 1.0 - finer.vertices[v].x / 8.0, 1e-12);
    }
}

TEST_F(CommandLine, BallsTellTheirStatistics) {
    const Outcome text = run({"balls", "box.off", "-o", "box.ply", "--delta-abs", "0.1"});
    EXPECT_EQ(text.status, 0);
    EXPECT_TRUE(contains(text.out, "box.ply")) << text.out;
    const Outcome json = run({"balls", "box.off", "-o", "box.ply", "--delta-abs", "0.1", "--stats", "-"});
    const Json document = Json::parse(json.out);
    EXPECT_EQ(document["schema"], "scaleaxis.balls/2");
    EXPECT_EQ(document["tolerance"], 0.1);
    EXPECT_GT(document["balls"], 10);
}

TEST_F(CommandLine, DeltaMayBeChosen) {
    const Outcome outcome = run({"axis", "box.off", "-o", "a.ply", "--delta", "auto", "--stats", "stats.json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.out, "0.02 chosen of 0.02 ... 0.0025\n")) << outcome.out;
    EXPECT_TRUE(contains(outcome.out, "meets the requirements")) << outcome.out;
    const Json document = Json::parse(content(folder_ / "stats.json"));
    EXPECT_EQ(document["options"]["delta"], "auto");
    const Json& choice = document["results"][0]["delta_choice"];
    EXPECT_EQ(choice["chosen"], 0.02);
    ASSERT_EQ(choice["attempts"].size(), 1U);
    EXPECT_EQ(choice["attempts"][0]["balls"], document["results"][0]["balls"]);
    EXPECT_EQ(choice["attempts"][0]["union"], choice["attempts"][0]["solid"]);
    EXPECT_TRUE(choice["attempts"][0]["fault"].is_null());

    ASSERT_EQ(run({"axis", "box.off", "-o", "b.ply", "--delta", "0.02", "-q"}).status, 0);
    EXPECT_EQ(content(folder_ / "a.ply"), content(folder_ / "b.ply"));
    const Outcome balls = run({"balls", "box.off", "-o", "balls.ply", "--delta", "auto", "--stats", "-"});
    ASSERT_EQ(balls.status, 0) << balls.err;
    EXPECT_EQ(Json::parse(balls.out)["delta_choice"]["chosen"], 0.02);
}

TEST_F(CommandLine, ThinPartsAreNamed) {
    write(folder_ / "plate.off",
          "OFF 8 6 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 .02\n1 0 .02\n0 1 .02\n1 1 .02\n"
          "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n");
    for (const Arguments& command : {Arguments{"balls"}, Arguments{"axis"}}) {
        Arguments arguments = command;
        arguments.insert(arguments.end(), {"plate.off", "-o", "out.ply", "--delta", "0.018", "--stats", "stats.json"});
        const Outcome outcome = run(arguments);
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_TRUE(contains(outcome.err, "--delta-abs 0.0")) << outcome.err;
        const Json document = Json::parse(content(folder_ / "stats.json"));
        const Json& result = command[0] == "axis" ? document["results"][0] : document;
        ASSERT_FALSE(result["warnings"].empty()) << command[0];
        EXPECT_EQ(result["warnings"][0]["code"], "axis.thin_part");
        EXPECT_NEAR(result["warnings"][0]["place"][2].get<double>(), 0.01, 1e-3);
        EXPECT_NEAR(result["fit"]["thin_part"]["thickness"].get<double>(), 0.02, 1e-3);
    }
}

TEST_F(CommandLine, BallsThatAreNoneAreRefused) {
    write(folder_ / "negative.balls", "0 0 0 1\n1 0 0 -1\n");
    const Outcome outcome = run({"medial", "negative.balls", "-o", "out.ply"});
    EXPECT_EQ(outcome.status, 3);
    expect_error_line(outcome, "negative.balls");
    EXPECT_EQ(files(), (std::set<std::string>{"box.off", "negative.balls"}));
}

TEST_F(CommandLine, MeshOfBallsIsAClosedSurface) {
    write(folder_ / "two.balls", "0 0 0 1\n1 0 0 1\n0 5 0 0.5\n");
    for (const std::string file : {"two.ply", "two.obj", "two.off", "two.stl"}) {
        SCOPED_TRACE(file);
        const Outcome outcome = run({"mesh", "two.balls", "-o", file, "--delta", "0.02", "--stats", "-"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        const Json document = Json::parse(outcome.out);
        EXPECT_EQ(document["schema"], "scaleaxis.mesh/2");
        EXPECT_EQ(document["balls"], 3);
        EXPECT_EQ(document["surface"]["mesh"]["euler"], 4);
        EXPECT_EQ(document["surface"]["mesh"]["boundary_edges"], 0);
        EXPECT_EQ(document["surface"]["lost_samples"], 0);
        const Json info = Json::parse(run({"info", file, "--json"}).out);
        EXPECT_EQ(info["mesh"]["solid"]["components"], 2);
        EXPECT_EQ(info["mesh"]["triangles"], document["surface"]["mesh"]["triangles"]);
        EXPECT_EQ(info["mesh"]["self_intersections"], 0);
        // Two unit balls at distance 1 are as large as 27/16 balls, and the third is an eighth of one.
        EXPECT_NEAR(info["mesh"]["volume"], (27.0 / 16.0 + 0.125) * 4.18879, 0.2);
    }
    EXPECT_TRUE(contains(run({"mesh", "two.balls", "-o", "two.off", "--delta", "0.05"}).out, "two.off"));
}

TEST_F(CommandLine, StoredAxesStandForASolidAtTheScaleOfTheirFile) {
    ASSERT_EQ(run({"axis", "box.off", "-o", "axis.ply", "--delta-abs", "0.08", "--scale", "2", "--clean", "0", "--mesh",
                   "mesh.ply", "-q"})
                  .status,
              0);
    ASSERT_EQ(run({"mesh", "axis.ply", "-o", "again.ply", "--delta-abs", "0.08", "-q"}).status, 0);
    EXPECT_TRUE(content(folder_ / "mesh.ply") == content(folder_ / "again.ply"));
    // Balls that only meet once they are grown: their axis is a long edge.
    write(folder_ / "two.balls", "0 0 0 1\n1.9 0 0 1\n");
    ASSERT_EQ(run({"medial", "two.balls", "-o", "long.ply", "--scale", "2", "-q"}).status, 0);
    ASSERT_EQ(run({"mesh", "long.ply", "-o", "known.ply", "--delta-abs", "0.05", "-q"}).status, 0);
    ASSERT_EQ(run({"mesh", "long.ply", "-o", "told.ply", "--delta-abs", "0.05", "--scale", "2", "-q"}).status, 0);
    ASSERT_EQ(run({"mesh", "long.ply", "-o", "one.ply", "--delta-abs", "0.05", "--scale", "1", "-q"}).status, 0);
    EXPECT_TRUE(content(folder_ / "known.ply") == content(folder_ / "told.ply"));
    EXPECT_FALSE(content(folder_ / "known.ply") == content(folder_ / "one.ply"));
    const auto distance_to_axis = [&](const std::string& mesh) {
        const Outcome outcome = run({"compare", mesh, "long.ply", "--json", "--spacing", "0.01"});
        return Json::parse(outcome.out)["hausdorff"]["absolute"].get<double>();
    };
    EXPECT_LT(distance_to_axis("known.ply"), 0.05);
    EXPECT_GT(distance_to_axis("one.ply"), 0.05);
    EXPECT_EQ(run({"mesh", "axis.ply", "-o", "x.ply", "--scale", "0.5"}).status, 2);
    EXPECT_EQ(run({"sample-field", "axis.ply", "-o", "x.nrrd", "--scale", "2", "--balls-only"}).status, 2);
}

TEST_F(CommandLine, RadiiUpToSharpEdgesAreLinearInAnyFile) {
    ASSERT_EQ(run({"axis", "box.off", "-o", "axis.ma", "--delta", "0.05", "-q"}).status, 0);
    const Json comparison = Json::parse(run({"compare", "box.off", "axis.ma", "--json", "--spacing", "0.01"}).out);
    EXPECT_LT(comparison["hausdorff"]["relative"], 1e-3);
    EXPECT_EQ(run({"refine", "axis.ma", "-o", "dense.ply", "-q"}).status, 0);
    const Outcome few = run({"simplify", "axis.ma", "-o", "few.ply", "--stats", "-"});
    ASSERT_EQ(few.status, 0) << few.err;
    EXPECT_LE(Json::parse(few.out)["after"]["vertices"], 40);
}

TEST_F(CommandLine, CommandsOnStoredAxesTellWhatTheyLeaveOut) {
    ASSERT_EQ(run({"filtration", "box.off", "-o", "nested.ply", "--delta", "0.05", "-q"}).status, 0);
    const Outcome nested = run({"clean", "nested.ply", "-o", "clean.ply", "-q"});
    EXPECT_EQ(nested.status, 0);
    EXPECT_TRUE(contains(nested.err, "filter --scale S")) << nested.err;
    EXPECT_EQ(run({"filter", "nested.ply", "-o", "cut.ply", "--scale", "1.1", "-q"}).err, "");
    expect_error_line(run({"simplify", "cut.ply", "-o", "x.ply", "--anchor", "1,2,nan"}), "must be numbers");
    expect_error_line(run({"simplify", "cut.ply", "-o", "x.ply", "--error-abs", "1000"}), "at most the diagonal");
    expect_error_line(run({"axis", "box.off", "-o", "x.ply", "--error-abs", "1000"}), "at most the diagonal");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "x.ply"));
}

TEST_F(CommandLine, MeshTellsWhatIsTooSmallForIt) {
    write(folder_ / "tiny.balls", "0 0 0 1\n0 2 0 1e-5\n");
    const Outcome outcome = run({"mesh", "tiny.balls", "-o", "tiny.ply", "--delta", "0.05", "-q"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(contains(outcome.err, "1 sample")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "Euler characteristic")) << outcome.err;
}

TEST_F(CommandLine, MeshOfNoBallsIsRefused) {
    write(folder_ / "none.balls", "# nothing\n");
    write(folder_ / "nan.balls", "0 0 0 1\n1 0 0 nan\n");
    EXPECT_EQ(run({"mesh", "none.balls", "-o", "out.ply"}).status, 4);
    EXPECT_EQ(run({"mesh", "nan.balls", "-o", "out.ply"}).status, 3);
    EXPECT_EQ(files(), (std::set<std::string>{"box.off", "none.balls", "nan.balls"}));
}

TEST_F(CommandLine, AxisWritesTheSimplifiedShape) {
    const Outcome outcome = run({"axis", "box.off", "-o", "axis.ply", "--delta", "0.05", "--scale", "1,1.5", "--mesh",
                                 "box.obj", "--stats", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Json axes = Json::parse(outcome.out)["results"][0]["axes"];
    for (const Json& axis : axes) {
        EXPECT_EQ(axis["surface"]["mesh"]["euler"], 2);
        const Json info = Json::parse(run({"info", axis["surface"]["file"], "--json"}).out);
        EXPECT_EQ(info["mesh"]["triangles"], axis["surface"]["mesh"]["triangles"]);
        EXPECT_GT(info["mesh"]["volume"], 0.7);  // balls within a unit cube leave its edges out
        EXPECT_LT(info["mesh"]["volume"], 1.0);
    }
    EXPECT_EQ(axes[1]["surface"]["file"], "box-s1.5.obj");
    // Any number of threads makes the same.
    const std::string one = content(folder_ / "box-s1.5.obj");
    ASSERT_EQ(run({"axis", "box.off", "-o", "axis.ply", "--delta", "0.05", "--scale", "1,1.5", "--mesh", "box.obj",
                   "-q", "--threads", "3"})
                  .status,
              0);
    EXPECT_EQ(content(folder_ / "box-s1.5.obj"), one);
}

TEST_F(CommandLine, SkeletonsOfFunctionsAndOfAxes) {
    const std::vector<std::string> bar{"--implicit", "sqrt((x-max(min(x,3),-3))^2+y^2+z^2)-0.5", "--bounds",
                                       "-4,-1,-1,4,1,1"};
    std::vector<std::string> arguments{"skeleton", "-o", "bar.swc",  "--delta", "0.02",
                                       "--stats",  "-",  "--radius", "mean"};
    arguments.insert(arguments.end(), bar.begin(), bar.end());
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Json skeleton = Json::parse(outcome.out)["skeleton"];
    EXPECT_EQ(skeleton["branches"], 1);
    EXPECT_EQ(skeleton["ends"], 2);
    EXPECT_EQ(skeleton["is_homotopic"], true);
    EXPECT_NEAR(skeleton["length"].get<double>(), 6.0, 0.2);
    EXPECT_NEAR(skeleton["mean_radius"].get<double>(), 0.5, 0.02);
    ASSERT_EQ(run({"axis", "box.off", "-o", "box.ply", "--delta", "0.05", "--no-sharp", "-q"}).status, 0);
    ASSERT_EQ(run({"skeleton", "box.ply", "-o", "box.graphml", "--scale", "1.1", "-q"}).status, 0);
    EXPECT_NE(content(folder_ / "box.graphml").find("<graphml"), std::string::npos);
    ASSERT_EQ(run({"skeleton", "box.off", "-o", "box.vtp", "--delta", "0.05", "--parts", "parts.ply", "-q"}).status, 0);
    EXPECT_NE(content(folder_ / "parts.ply").find("property int branch"), std::string::npos);
    EXPECT_EQ(run({"skeleton", "box.ply", "-o", "box.swc", "--delta", "0.05"}).status, 2);
    EXPECT_EQ(run({"skeleton", "box.ply", "-o", "box.swc", "--view", "box.html", "-q"}).status, 0);
    EXPECT_GT(content(folder_ / "box.html").size(), 100000u);
    EXPECT_EQ(run({"skeleton", "box.off", "-o", "box.swc", "--view", "box.png"}).status, 2);
    EXPECT_EQ(run({"skeleton", "box.off", "-o", "box.swc", "--parts", "x.ply", "--view", "box.off"}).status, 2);
    EXPECT_EQ(run({"skeleton", "box.off", "-o", "box.stl"}).status, 2);
}

// A ball has a skeleton of one node, and so no parts.
TEST_F(CommandLine, ATableOfPartsHasARowForABall) {
    const Arguments ball{"--implicit", "x^2+y^2+z^2-1", "--bounds", "-2,-2,-2,2,2,2", "--rows", "part", "-q"};
    const auto table = [&](const std::string& file) {
        Arguments arguments{"table", "-o", file};
        arguments.insert(arguments.end(), ball.begin(), ball.end());
        EXPECT_EQ(run(arguments).status, 0);
        return content(folder_ / file);
    };
    const std::string text = table("one.csv");
    EXPECT_TRUE(text.starts_with("input,label,component,part,unit,")) << text;
    EXPECT_EQ(std::ranges::count(text, '\n'), 2);
    const Json rows = Json::parse(table("one.json"))["rows"];
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0]["part"], 0);
    EXPECT_EQ(rows[0]["branches"], 0);
    EXPECT_NEAR(rows[0]["area"].get<double>(), 12.57, 0.05);
}

// Of its grown balls, whose radii have been divided, a file that names none must not be taken for the union: they
// hardly overlap.
TEST_F(CommandLine, SkeletonsOfMaAreThoseOfPly) {
    write(folder_ / "rod.off", box_off(0, 0, 0, 1));
    for (const std::string delta : {"0.01", "0.02"}) {
        SCOPED_TRACE(delta);
        for (const std::string extension : {".ma", ".ply"}) {
            ASSERT_EQ(
                run({"axis", "rod.off", "-o", "rod" + extension, "--delta", delta, "--no-sharp", "--clean", "0", "-q"})
                    .status,
                0);
            const Outcome outcome = run({"skeleton", "rod" + extension, "-o", extension.substr(1) + ".json", "-q"});
            ASSERT_EQ(outcome.status, 0) << outcome.err;
        }
        const Json of_ma = Json::parse(content(folder_ / "ma.json"));
        const Json of_ply = Json::parse(content(folder_ / "ply.json"));
        EXPECT_EQ(of_ma["branches"].size(), of_ply["branches"].size());
        const auto count = [](const Json& skeleton) { return static_cast<double>(skeleton["nodes"].size()); };
        EXPECT_NEAR(count(of_ma), count(of_ply), 3.0);
    }
}

TEST_F(CommandLine, SkeletonsAsCenterlinesAndTrees) {
    const std::vector<std::string> ring{
        "--implicit", "sqrt((sqrt(x^2+y^2)-2)^2+z^2)-0.5", "--bounds", "-3,-3,-1,3,3,1", "--delta", "0.02"};
    const auto skeleton = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "skeleton");
        arguments.insert(arguments.end(), ring.begin(), ring.end());
        return run(arguments);
    };
    const Outcome swc = skeleton({"-o", "ring.swc", "--step-abs", "0.5"});
    ASSERT_EQ(swc.status, 0) << swc.err;
    EXPECT_NE(swc.err.find("1 is cut"), std::string::npos) << swc.err;
    // 4 pi in steps of at most 0.5 are 26.
    EXPECT_NE(content(folder_ / "ring.swc").find("\n26 0 "), std::string::npos);
    EXPECT_EQ(content(folder_ / "ring.swc").find("\n27 0 "), std::string::npos);
    const Outcome json =
        skeleton({"-o", "ring.json", "--sections", "-q", "--root", "0,2,0", "--path", "2,0,0", "0,-2,0"});
    ASSERT_EQ(json.status, 0) << json.err;
    EXPECT_EQ(json.err, "");
    const Json path = Json::parse(content(folder_ / "ring.json"));
    ASSERT_EQ(path["branches"].size(), 1u);
    EXPECT_NEAR(path["branches"][0]["length"].get<double>(), 3.14, 0.2);  // a quarter, and not three
    EXPECT_NEAR(path["nodes"][0]["place"][0].get<double>(), 2.0, 0.1);
    EXPECT_EQ(path["root"], 0);
    for (const std::string file : {"ring.graphml", "ring.PLY"}) {
        expect_error_line(skeleton({"-o", file, "--root", "0,2,0"}), "--root has no effect on .");
    }
    for (const Json& node : path["nodes"]) {
        EXPECT_NEAR(node["section"]["area"].get<double>(), 0.785, 0.05);
        EXPECT_EQ(node["section"]["is_closed"], true);
    }
    ASSERT_EQ(run({"axis", "box.off", "-o", "box.ply", "--delta", "0.05", "--no-sharp", "-q"}).status, 0);
    expect_error_line(run({"skeleton", "box.ply", "-o", "box.vtp", "--sections"}), "--sections has no effect");
    expect_error_line(skeleton({"-o", "ring.swc", "--sections"}), "--sections has no effect on .swc");
    expect_error_line(skeleton({"-o", "ring.swc", "--root", "1,2"}), "--root takes X,Y,Z");
    expect_error_line(run({"mesh", "box.off", "-o", "x.ply"}), "box.off: its format, .off, is none of balls: .ply");
    expect_error_line(run_with_input({"mesh", "-", "-o", "x.ply", "--scale", "1.5"}, "0 0 0 1\n1 0 0 1\n"),
                      "--scale has no effect on balls");
    expect_error_line(skeleton({"-o", "ring.swc", "--parts", "x.ply", "--path", "2,0,0", "0,-2,0"}), "--path");
    EXPECT_EQ(skeleton({"-o", "ring.swc", "--path", "2,0,0"}).status, 2);
}

TEST_F(CommandLine, SizesGoToFilesOfMeshers) {
    scaleaxis::write_mesh(folder_ / "plate.off", scaleaxis::test::box_mesh({0, 0, 0}, {5, 3, 0.5}));
    for (const std::string name : {"a.pos", "a.msh", "a.sol"}) {
        const Outcome outcome =
            run({"sizes", "plate.off", "--elements-across", "2", "--max-size", "1", "-o", name, "--stats", "-"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        const Json result = Json::parse(outcome.out);
        EXPECT_EQ(result["schema"], "scaleaxis.sizes/1");
        EXPECT_NEAR(result["least"].get<double>(), 0.25, 1e-3);
        EXPECT_EQ(result["of"], "thickness");
    }
    EXPECT_TRUE(content(folder_ / "a.pos").find("\nSS(") != std::string::npos);
    EXPECT_TRUE(content(folder_ / "a.msh").starts_with("$MeshFormat\n4.1 0 8\n"));
    EXPECT_NE(content(folder_ / "a.mesh").find("\nTriangles\n"), std::string::npos);

    // The same places in both, far from the origin, too.
    scaleaxis::write_mesh(folder_ / "far.off", scaleaxis::test::box_mesh({1e6, 0, 0}, {1e6 + 5, 3, 0.5}));
    for (const std::string name : {"far.pos", "far.msh"}) {
        ASSERT_EQ(run({"sizes", "far.off", "--max-size", "1", "-o", name, "-q"}).status, 0);
    }
    const std::string nodes = content(folder_ / "far.msh");
    const std::size_t end = nodes.find("\n$EndNodes");
    std::string place = nodes.substr(nodes.rfind('\n', end - 1) + 1, end - nodes.rfind('\n', end - 1) - 1);
    std::ranges::replace(place, ' ', ',');
    EXPECT_NE(content(folder_ / "far.pos").find(place), std::string::npos) << place;

    // Of a mesh that is there already: at the vertices of the file before.
    ASSERT_EQ(
        run({"sizes", "plate.off", "--elements-across", "2", "--max-size", "1", "--at", "a.mesh", "-o", "b.sol", "-q"})
            .status,
        0);
    EXPECT_EQ(content(folder_ / "a.sol"), content(folder_ / "b.sol"));
    EXPECT_EQ(run({"sizes", "plate.off", "--at", "a.mesh", "-o", "c.pos"}).status, 2);
    EXPECT_EQ(run({"sizes", "plate.off", "--at", "plate.off", "-o", "c.sol"}).status, 3);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "c.sol"));
    EXPECT_EQ(run({"sizes", "plate.off", "--at", "a.mesh", "-o", "a.sol", "-q"}).status, 0);
    EXPECT_EQ(run({"sizes", "plate.off", "-o", "a.stl"}).status, 2);
    EXPECT_EQ(run({"sizes", "plate.off", "-o", "a.pos", "--gradation", "0"}).status, 2);
    EXPECT_EQ(run({"sizes", "plate.off", "-o", "a.pos", "--min-size", "2", "--max-size", "1"}).status, 2);

    expect_error_line(run({"sizes", "plate.off", "-o", "-", "--output-format", "sol"}),
                      "a .sol has its mesh beside it");

    // What is written beside is no input.
    std::filesystem::copy(folder_ / "plate.off", folder_ / "plate.mesh");
    expect_error_line(run({"sizes", "plate.mesh", "-o", "plate.sol"}), "plate.mesh");
    EXPECT_EQ(content(folder_ / "plate.mesh"), content(folder_ / "plate.off"));
}

TEST_F(CommandLine, MidsurfacesHaveSheetsWithThickness) {
    scaleaxis::write_mesh(folder_ / "plate.off", scaleaxis::test::box_mesh({0, 0, 0}, {5, 3, 0.5}));
    const Outcome outcome = run({"midsurface", "plate.off", "--delta", "0.015", "-o", "mid.ply", "--stats", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Json result = Json::parse(outcome.out);
    EXPECT_EQ(result["schema"], "scaleaxis.midsurface/1");
    const Json& found = result["midsurface"];
    EXPECT_EQ(run({"midsurface", "plate.off", "--delta", "0.05", "-o", "mid.STL", "-q"}).status, 0);
    ASSERT_EQ(found["sheets"].size(), 1u);
    EXPECT_NEAR(found["sheets"][0]["area"].get<double>(), 15.0, 0.3);
    EXPECT_NEAR(found["sheets"][0]["mean_thickness"].get<double>(), 0.5, 0.005);
    EXPECT_EQ(found["seams"], 0);
    EXPECT_NEAR(found["border_length"].get<double>(), 16.0, 0.4);
    const scaleaxis::MedialComplex read = scaleaxis::read_axis(folder_ / "mid.ply");
    EXPECT_EQ(read.faces.size(), found["triangles"].get<std::size_t>());
    EXPECT_EQ(read.sheets, 1);
    EXPECT_NE(content(folder_ / "mid.ply").find("property double thickness"), std::string::npos);

    // The same of an axis; other formats.
    ASSERT_EQ(run({"axis", "plate.off", "--delta", "0.015", "-o", "axis.ply", "-q"}).status, 0);
    const Outcome stored = run({"midsurface", "axis.ply", "--no-extend", "-o", "mid.obj"});
    ASSERT_EQ(stored.status, 0) << stored.err;
    EXPECT_NE(stored.out.find("1 sheet, area 11.2"), std::string::npos) << stored.out;
    EXPECT_NE(content(folder_ / "mid.obj").find("g sheet_0"), std::string::npos);
    for (const std::string name : {"mid.vtp", "mid.glb", "mid.stl", "mid.off"}) {
        EXPECT_EQ(run({"midsurface", "axis.ply", "-o", name, "-q"}).status, 0);
        EXPECT_GT(content(folder_ / name).size(), 1000u);
    }
    EXPECT_EQ(scaleaxis::read_mesh(folder_ / "mid.stl").triangles.size(), found["triangles"].get<std::size_t>());
    EXPECT_EQ(scaleaxis::read_mesh(folder_ / "mid.off").triangles.size(), found["triangles"].get<std::size_t>());

    // As shells, of both.
    const Outcome shells = run({"midsurface", "plate.off", "--delta", "0.015", "--shells", "a.inp", "--shells", "a.vtu",
                                "--size", "0.5", "--stats", "-"});
    ASSERT_EQ(shells.status, 0) << shells.err;
    const Json mesh = Json::parse(shells.out)["shells"];
    EXPECT_NEAR(mesh["sheets"][0]["area"].get<double>(), 15.0, 1e-3);
    EXPECT_NEAR(mesh["border_length"].get<double>(), 16.0, 1e-3);
    EXPECT_EQ(mesh["files"], Json({"a.inp", "a.vtu"}));
    EXPECT_NE(content(folder_ / "a.inp").find("*ELEMENT, TYPE=S6, ELSET=SHEET1"), std::string::npos);
    ASSERT_EQ(run({"midsurface", "axis.ply", "--shells", "a.bdf", "--size", "0.5", "--order", "1", "-q"}).status, 0);
    EXPECT_NE(content(folder_ / "a.bdf").find("CTRIA3  "), std::string::npos);
    EXPECT_EQ(run({"midsurface", "axis.ply", "-o", "a.ply", "--order", "2"}).status, 2);
    EXPECT_EQ(run({"midsurface", "axis.ply", "--shells", "a.inp"}).status, 2);
    EXPECT_EQ(run({"midsurface", "axis.ply", "--shells", "a.stl", "--size", "1"}).status, 2);
    EXPECT_EQ(run({"midsurface", "axis.ply", "-o", "mid.ply", "--size", "1"}).status, 2);
    EXPECT_EQ(run({"midsurface", "axis.ply"}).status, 2);
    EXPECT_EQ(run({"midsurface", "axis.ply", "--shells", "b.inp", "--size", "1000", "-q"}).status, 4);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "b.inp"));

    scaleaxis::write_mesh(folder_ / "ball.off", scaleaxis::test::sphere_mesh({0, 0, 0}, 1, 3));
    const Outcome none = run({"midsurface", "ball.off", "--delta", "0.05", "-o", "none.ply"});
    EXPECT_EQ(none.status, 4);
    EXPECT_NE(none.err.find("no midsurface"), std::string::npos) << none.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "none.ply"));
    EXPECT_EQ(run({"midsurface", "axis.ply", "--delta", "0.05", "-o", "mid.ply"}).status, 2);
    EXPECT_EQ(run({"midsurface", "plate.off", "-o", "mid.csv"}).status, 2);
    EXPECT_EQ(run({"midsurface", "plate.off", "-o", "mid.ply", "--angle", "0"}).status, 2);
}

TEST_F(CommandLine, ThicknessTellsThinRegionsAndWritesSurfaceAndImage) {
    scaleaxis::write_mesh(folder_ / "plate.off", scaleaxis::test::box_mesh({0, 0, 0}, {4, 3, 0.5}));
    const Outcome outcome = run({"thickness", "plate.off", "--delta", "0.03", "--edge", "0.04", "--limit", "0.6", "-o",
                                 "plate.ply", "--image", "plate.nrrd", "--resolution", "24", "--stats", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Json result = Json::parse(outcome.out);
    EXPECT_EQ(result["schema"], "scaleaxis.thickness/1");
    EXPECT_NEAR(result["local"]["mean"].get<double>(), 0.5, 0.01);
    EXPECT_LT(result["foot"]["mean"].get<double>(), result["local"]["mean"].get<double>());
    ASSERT_EQ(result["regions"].size(), 1u);
    EXPECT_NEAR(result["regions"][0]["area"].get<double>(), 2 * 12 + 7, 0.01);
    EXPECT_EQ(result["histogram"]["areas"].size(), 20u);
    const Json surface = Json::parse(run({"info", "plate.ply", "--json"}).out);
    EXPECT_EQ(surface["mesh"]["euler"], 2);
    EXPECT_NE(content(folder_ / "plate.ply").find("property double local_thickness"), std::string::npos);
    EXPECT_NE(content(folder_ / "plate.nrrd").find("sizes: 24 "), std::string::npos);

    // The same of an axis, at the vertices of a mesh; other formats.
    ASSERT_EQ(run({"axis", "plate.off", "--delta", "0.03", "-o", "axis.ply", "-q"}).status, 0);
    const Outcome stored =
        run({"thickness", "axis.ply", "--surface", "plate.off", "--edge", "0.04", "-o", "plate.csv", "--stats", "-"});
    ASSERT_EQ(stored.status, 0) << stored.err;
    EXPECT_NEAR(Json::parse(stored.out)["local"]["mean"].get<double>(), 0.5, 0.01);
    EXPECT_EQ(content(folder_ / "plate.csv").substr(0, 40), "x,y,z,local_thickness,foot_thickness,bal");
    for (const std::string name : {"plate.vtp", "plate.glb"}) {
        EXPECT_EQ(run({"thickness", "axis.ply", "--edge", "0", "-o", name, "-q"}).status, 0);
        EXPECT_GT(content(folder_ / name).size(), 1000u);
    }
    EXPECT_EQ(run({"thickness", "plate.off", "--surface", "plate.off"}).status, 2);
    EXPECT_EQ(run({"thickness", "plate.off", "-o", "plate.stl"}).status, 2);
    const Outcome page = run({"thickness", "axis.ply", "--edge", "0", "--view", "plate.html"});
    EXPECT_TRUE(page.status == 0 && page.out.find("plate.html") != std::string::npos) << page.out << page.err;
    EXPECT_GT(content(folder_ / "plate.html").size(), 100000u);
    EXPECT_EQ(run({"thickness", "plate.off", "--view", "plate.png"}).status, 2);
    EXPECT_EQ(run({"thickness", "plate.off", "--view", "x.html", "--stats", "x.html"}).status, 2);
    EXPECT_EQ(run({"thickness", "plate.off", "--limit", "-1"}).status, 2);
}

TEST_F(CommandLine, WallsTellsFindingsByItsStatusAndAsJson) {
    scaleaxis::write_mesh(folder_ / "plate.off", scaleaxis::test::box_mesh({0, 0, 0}, {4, 3, 0.5}));
    const Outcome found = run({"walls", "plate.off", "--min-wall", "0.6", "-o", "found.json", "--mesh", "plate.ply",
                               "--view", "plate.html", "--stats", "stats.json"});
    EXPECT_EQ(found.status, 6) << found.err;
    EXPECT_TRUE(contains(found.out, "thin wall: 0.5") && contains(found.out, "plate.html")) << found.out;
    const Json document = Json::parse(content(folder_ / "found.json"));
    EXPECT_EQ(document["schema"], "scaleaxis.walls/1");
    EXPECT_EQ(document["limits"]["min_wall"], 0.6);
    EXPECT_TRUE(document["limits"]["min_gap"].is_null());
    ASSERT_EQ(document["findings"].size(), 1u);
    const Json finding = document["findings"][0];
    EXPECT_EQ(finding["kind"], "thin_wall");
    EXPECT_NEAR(finding["value"].get<double>(), 0.5, 0.002);
    EXPECT_NEAR(finding["place"][2].get<double>(), 0.25, 0.002);
    EXPECT_NEAR(std::abs(finding["direction"][2].get<double>()), 1.0, 0.01);
    EXPECT_NEAR(finding["area"].get<double>(), 2 * 12 + 7, 0.1);
    EXPECT_EQ(Json::parse(content(folder_ / "stats.json"))["findings"], document["findings"]);
    EXPECT_NE(content(folder_ / "plate.ply").find("property double wall"), std::string::npos);

    EXPECT_EQ(run({"walls", "plate.off", "--min-wall", "0.6", "--exit-zero"}).status, 0);
    const Outcome none = run({"walls", "plate.off", "--min-wall", "0.5", "--min-gap", "1"});
    EXPECT_TRUE(none.status == 0 && contains(none.out, "none")) << none.out << none.err;
    expect_error_line(run({"walls", "plate.off"}), "--min-wall");
    EXPECT_EQ(run({"walls", "plate.off", "--min-wall", "0"}).status, 2);
    EXPECT_EQ(run({"walls", "plate.off", "--min-wall", "1", "--mesh", "plate.stl"}).status, 2);

    // A gap between the objects is none of one of them; a failure counts more than findings.
    write_two_boxes_gltf(folder_ / "two.gltf", 0.25);
    EXPECT_EQ(run({"walls", "two.gltf", "--min-gap", "0.3"}).status, 6);
    EXPECT_EQ(run({"walls", "two.gltf", "--min-gap", "0.3", "--each-object"}).status, 0);
    EXPECT_EQ(run({"walls", "two.gltf", "--min-wall", "1.5", "--each-object", "-o", "{name}.json"}).status, 6);
    EXPECT_TRUE(fs::exists(folder_ / "two-object2.json"));
}

TEST_F(CommandLine, AxisMakesAPageOfAllInputsOrOneOfEach) {
    write(folder_ / "other.off", box_off(5, 5, 5, 2));
    const Arguments common{"axis",    "missing.off", "box.off", "other.off", "-o", "{name}-{scale}.ply",
                           "--delta", "0.1",         "--scale", "1,1.5",     "-q", "--view"};
    Arguments one = common;
    one.emplace_back("page.html");
    EXPECT_EQ(run(one).status, 3);  // the page shows those that did not fail
    EXPECT_EQ(models_of(content(folder_ / "page.html")), 2u);
    Arguments each = common;
    each.emplace_back("{name}.html");
    EXPECT_EQ(run(each).status, 3);
    EXPECT_EQ(models_of(content(folder_ / "box.html")), 1u);
    EXPECT_EQ(models_of(content(folder_ / "other.html")), 1u);
    EXPECT_FALSE(files().contains("missing.html"));
}

TEST_F(CommandLine, ViewMakesAPageOfResults) {
    fs::create_directory(folder_ / "results");
    ASSERT_EQ(run({"axis", "box.off", "-o", "results", "--delta", "0.1", "--scale", "1,1.5", "--mesh", "results",
                   "--stats", "results/s.json"})
                  .status,
              0);
    const Outcome folder = run({"view", "results", "-o", "folder.html"});
    ASSERT_EQ(folder.status, 0) << folder.err;
    EXPECT_EQ(folder.err, "");
    EXPECT_TRUE(contains(folder.out, "folder.html")) << folder.out;
    EXPECT_EQ(models_of(content(folder_ / "folder.html")), 1u);  // two scales of one model
    EXPECT_GT(content(folder_ / "folder.html").size(), 500000u);

    const Outcome axes = run({"view", "results/box-axis-s1.ply", "results/box-axis-s1.5.ply", "box.off", "--shape",
                              "box.off", "-o", "axes.html", "-q"});
    ASSERT_EQ(axes.status, 0) << axes.err;
    EXPECT_EQ(axes.out + axes.err, "");
    EXPECT_EQ(models_of(content(folder_ / "axes.html")), 2u);  // the axis and the mesh

    fs::remove(folder_ / "box.off");
    const Outcome shapeless = run({"view", "results/s.json", "-o", "shapeless.html", "-q"});
    EXPECT_EQ(shapeless.status, 0);
    EXPECT_TRUE(contains(shapeless.err, "box.off")) << shapeless.err;
    // All moved elsewhere, axes beside their statistics.
    fs::rename(folder_ / "results", folder_ / "moved");
    EXPECT_EQ(run({"view", "moved/s.json", "-o", "moved.html", "-q"}).status, 0);
    EXPECT_EQ(content(folder_ / "moved.html"), content(folder_ / "shapeless.html"));
}

TEST_F(CommandLine, ShapesOfAViewReplaceNoSurfaceWithValues) {
    ASSERT_EQ(run({"thickness", "box.off", "-o", "box-thickness.ply", "--delta", "0.2", "-q"}).status, 0);
    ASSERT_EQ(run({"view", "box-thickness.ply", "-o", "alone.html", "-q"}).status, 0);
    const Outcome outcome = run({"view", "box-thickness.ply", "--shape", "box.off", "-o", "page.html", "-q"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(contains(outcome.err, "--shape has no effect")) << outcome.err;
    EXPECT_EQ(content(folder_ / "page.html"), content(folder_ / "alone.html"));
}

TEST_F(CommandLine, ViewNamesWhatItCannotShow) {
    fs::create_directory(folder_ / "empty");
    write(folder_ / "other.json", "{\"schema\": \"scaleaxis.info/1\"}");
    write(folder_ / "torn.json", R"({"schema": "scaleaxis.axis/1", "results": [{"status": 0}]})");
    write(folder_ / "gone.json",
          R"({"schema": "scaleaxis.axis/1", "options": {}, "results": [{"status": 0, "input": "a.off",
              "axes": [{"file": "gone.ply", "scale": 1}]}]})");
    for (const std::string name : {"empty", "missing.ply", "other.json", "torn.json", "gone.json"}) {
        const Outcome outcome = run({"view", name, "-o", "page.html"});
        EXPECT_EQ(outcome.status, 3) << name;
        expect_error_line(outcome, name);
    }
    EXPECT_FALSE(files().contains("page.html"));
}

TEST_F(CommandLine, FieldOfBallsIsAnImage) {
    write(folder_ / "two.balls", "0 0 0 1\n1 0 0 1\n");
    const Outcome outcome =
        run({"sample-field", "two.balls", "-o", "{name}.nrrd", "--resolution", "32", "--stats", "-"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const Json document = Json::parse(outcome.out);
    EXPECT_EQ(document["schema"], "scaleaxis.field/1");
    EXPECT_EQ(document["sizes"][0], 32);
    EXPECT_TRUE(contains(content(folder_ / "two.nrrd"), "sizes: 32 "));
    EXPECT_TRUE(contains(run({"sample-field", "two.balls", "-o", "two.nrrd"}).out, "two.nrrd"));
    EXPECT_EQ(run({"sample-field", "missing.balls", "-o", "out.nrrd"}).status, 3);
}

TEST_F(CommandLine, CompareMeasuresMeshesAndBalls) {
    write(folder_ / "moved.off", box_off(0.1, 0, 0, 1));
    write(folder_ / "ball.balls", "0.5 0.5 0.5 0.5\n");
    const double diagonal = std::sqrt(3.0);
    const Json meshes = Json::parse(run({"compare", "box.off", "moved.off", "--json"}).out);
    EXPECT_EQ(meshes["schema"], "scaleaxis.compare/1");
    EXPECT_NEAR(meshes["hausdorff"]["absolute"], 0.1, 1e-3);
    EXPECT_NEAR(meshes["hausdorff"]["relative"], 0.1 / diagonal, 1e-3);
    EXPECT_GE(meshes["hausdorff"]["absolute"].get<double>() + meshes["error"]["absolute"].get<double>(), 0.1 - 1e-9);
    EXPECT_NEAR(meshes["spacing"]["relative"], 0.002, 1e-12);
    // A corner of the box is √3/2 from the centre of its largest ball; the ball touches the sides.
    const Json mixed = Json::parse(run({"compare", "box.off", "ball.balls", "--json", "--spacing", "0.01"}).out);
    EXPECT_NEAR(mixed["a_to_b"]["max"]["absolute"], diagonal / 2 - 0.5, 1e-3);
    EXPECT_NEAR(mixed["b_to_a"]["max"]["absolute"], 0.5 - 0.5 / diagonal, 1e-2);
    EXPECT_EQ(mixed["b"]["kind"], "balls");
    const Outcome text = run({"compare", "ball.balls", "box.off", "--spacing", "0.05"});
    EXPECT_EQ(text.status, 0);
    EXPECT_TRUE(contains(text.out, "two-sided")) << text.out;
}

TEST_F(CommandLine, CompareTellsWhatReadingRepaired) {
    write(folder_ / "box.stl", stl_without_count(scaleaxis::read_mesh(folder_ / "box.off")));
    const Outcome outcome = run({"compare", "box.off", "box.stl", "--json"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(contains(outcome.err, "warning: box.stl: its head says 0 facets, but there are 12")) << outcome.err;
    EXPECT_NEAR(Json::parse(outcome.out)["hausdorff"]["absolute"].get<double>(), 0.0, 1e-12);
}

TEST_F(CommandLine, CompareOfNoSurfaceIsRefused) {
    write(folder_ / "none.balls", "# nothing\n");
    write(folder_ / "none.off", "OFF\n0 0 0\n");
    EXPECT_EQ(run({"compare", "box.off", "none.balls"}).status, 4);
    EXPECT_EQ(run({"compare", "none.off", "box.off"}).status, 4);
    EXPECT_EQ(run({"compare", "box.off", "missing.off"}).status, 3);
}

TEST_F(CommandLine, SamplesAreAsDenseAsTheSolidNeedsOrUniform) {
    for (const std::string command : {"axis", "balls"}) {
        const auto statistics = [&](const Arguments& more) {
            Arguments arguments{command, "box.off", "-o", "out.ply", "--delta", "0.01", "--stats", "-"};
            arguments.insert(arguments.end(), more.begin(), more.end());
            const Json document = Json::parse(run(arguments).out);
            return command == "axis" ? document["results"][0] : document;
        };
        const Json adaptive = statistics({});
        const Json uniform = statistics({"--sampling", "uniform"});
        EXPECT_EQ(adaptive["sampling"], statistics({"--sampling", "adaptive"})["sampling"]) << command;
        EXPECT_GT(uniform["samples"].get<int>(), 2 * adaptive["samples"].get<int>()) << command;
        EXPECT_GT(adaptive["sampling"]["dip_facets"].get<int>(), 0) << command;
        EXPECT_EQ(uniform["sampling"]["dip_facets"], 0) << command;
    }
}

TEST_F(CommandLine, RetiredOptionsSayWhatTakesTheirPlace) {
    for (const std::string option : {"--features", "--tight"}) {
        const Outcome outcome = run({"axis", "box.off", "-o", "axis.ply", option});
        EXPECT_EQ(outcome.status, 2) << option;
        EXPECT_TRUE(contains(outcome.err, option + " is gone")) << outcome.err;
        EXPECT_TRUE(contains(outcome.err, "--sampling adaptive")) << outcome.err;
    }
}

TEST_F(CommandLine, BallsMayBeFitted) {
    for (const std::string command : {"axis", "balls"}) {
        const auto statistics = [&](const Arguments& more) {
            Arguments arguments{command, "box.off", "-o", "out.ply", "--delta", "0.1", "--stats", "-"};
            arguments.insert(arguments.end(), more.begin(), more.end());
            const Json document = Json::parse(run(arguments).out);
            return command == "axis" ? document["results"][0] : document;
        };
        const Json fitted = statistics({"--union", "fitted"});
        EXPECT_EQ(fitted["fit"]["inexact"], 0) << command;
        EXPECT_EQ(fitted["fit"]["repair"]["topology"]["components"], 1) << command;
        EXPECT_GT(fitted["fit"]["accuracy"]["thickest"]["radius"], 0.0) << command;
        EXPECT_TRUE(statistics({"--union", "polar"})["fit"].is_null()) << command;
    }
    const Outcome text = run({"balls", "box.off", "-o", "out.ply", "--delta", "0.1", "--union", "fitted"});
    EXPECT_NE(text.out.find("accuracy"), std::string::npos);
}

TEST_F(CommandLine, AnAxisIsAUnionOfBalls) {
    ASSERT_EQ(run({"axis", "box.off", "-o", "axis.ply", "--delta", "0.1", "--mesh", "mesh.off", "-q"}).status, 0);
    ASSERT_EQ(run({"axis", "box.off", "-o", "axis.ma", "--delta", "0.1", "-q"}).status, 0);
    const double tolerance = 0.1 * std::sqrt(3.0);
    for (const std::string axis : {"axis.ply", "axis.ma"}) {
        SCOPED_TRACE(axis);
        ASSERT_EQ(run({"mesh", axis, "-o", "again.off", "--delta-abs", std::to_string(tolerance), "-q"}).status, 0);
        const Json distance = Json::parse(run({"compare", "again.off", axis, "--json", "--spacing", "0.05"}).out);
        EXPECT_LT(distance["hausdorff"]["absolute"], tolerance);
        const Json same = Json::parse(run({"compare", "again.off", "mesh.off", "--json", "--spacing", "0.05"}).out);
        EXPECT_LT(same["hausdorff"]["absolute"], tolerance);
    }
    EXPECT_EQ(run({"sample-field", "axis.ma", "-o", "axis.nrrd", "-q"}).status, 0);
}

TEST_F(CommandLine, InfoDescribesAMesh) {
    const Outcome text = run({"info", "box.off"});
    EXPECT_EQ(text.status, 0);
    EXPECT_TRUE(contains(text.out, "8 vertices, 12 triangles; 1 component, genus 0")) << text.out;
    const Json document = Json::parse(run({"info", "box.off", "--json"}).out);
    EXPECT_EQ(document["schema"], "scaleaxis.info/2");
    EXPECT_EQ(document["kind"], "mesh");
    EXPECT_EQ(document["mesh"]["triangles"], 12);
    EXPECT_EQ(document["mesh"]["bounds"]["max"], (Json{1.0, 1.0, 1.0}));
    EXPECT_EQ(document["mesh"]["solid"]["euler"], 1);
    EXPECT_TRUE(document["mesh"]["fault"].is_null());
}

TEST_F(CommandLine, InfoTellsWarningsInJsonToo) {
    write(folder_ / "box.stl", stl_without_count(scaleaxis::read_mesh(folder_ / "box.off")));
    const Json warnings = Json::parse(run({"info", "box.stl", "--json"}).out)["mesh"]["warnings"];
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_TRUE(contains(warnings[0]["message"], "its head says 0 facets, but there are 12"));
    EXPECT_TRUE(contains(run({"info", "box.stl"}).out, "its head says 0 facets"));
    EXPECT_EQ(Json::parse(run({"info", "box.off", "--json"}).out)["mesh"]["warnings"], Json::array());
}

TEST_F(CommandLine, InfoNamesTheHolesOfAMesh) {
    write(folder_ / "open.off", box_off(0, 0, 0, 1, 11));
    const Json document = Json::parse(run({"info", "open.off", "--json"}).out);
    EXPECT_EQ(document["mesh"]["warnings"][0]["code"], "mesh.holes");
    EXPECT_EQ(document["mesh"]["boundary_edges"], 3);
    EXPECT_TRUE(document["mesh"]["fault"].is_null());
    ASSERT_EQ(document["mesh"]["holes"].size(), 1u);
    EXPECT_EQ(document["mesh"]["holes"][0]["edges"], 3);
    EXPECT_EQ(document["mesh"]["holes"][0]["place"].size(), 3u);
    const auto center = document["mesh"]["holes"][0]["center"].get<std::array<double, 3>>();
    EXPECT_EQ(center[0], 1.0);
    EXPECT_NEAR(center[1], std::sqrt(0.125), 1e-12);  // the diagonal of the side counts by its length
    EXPECT_NEAR(center[2], 1.0 - std::sqrt(0.125), 1e-12);
    EXPECT_EQ(document["mesh"]["method"]["name"], "winding");
    EXPECT_EQ(document["mesh"]["solid"]["euler"], 1);
    const Outcome text = run({"info", "open.off"});
    EXPECT_EQ(text.status, 0);
    EXPECT_TRUE(contains(text.out, "3 boundary edges")) << text.out;
    EXPECT_TRUE(contains(text.out, "winding: 1 hole closed")) << text.out;
}

TEST_F(CommandLine, InfoWritesTheRepairedMesh) {
    write(folder_ / "open.off", box_off(0, 0, 0, 1, 11));
    EXPECT_EQ(run({"info", "open.off", "--repaired", "closed.off"}).status, 0);
    const Json closed = Json::parse(run({"info", "closed.off", "--json"}).out);
    EXPECT_EQ(closed["mesh"]["boundary_edges"], 0);
    EXPECT_EQ(closed["mesh"]["triangles"], 12);
    EXPECT_NE(run({"info", "open.off", "--repaired", "open.off"}).status, 0);
    EXPECT_NE(run({"info", "open.off", "--repaired", "closed.txt"}).status, 0);
}

TEST_F(CommandLine, InfoNamesTheFaultOfAMesh) {
    write(folder_ / "sheet.off", box_off(0, 0, 0, 1, 1));
    const Json document = Json::parse(run({"info", "sheet.off", "--json"}).out);
    EXPECT_EQ(document["mesh"]["fault"]["code"], "mesh.sheet");
    EXPECT_TRUE(document["mesh"]["fault"]["message"].is_string());
    EXPECT_EQ(document["mesh"]["fault"]["place"].size(), 3u);
    EXPECT_TRUE(document["mesh"]["solid"].is_null());
    EXPECT_TRUE(document["mesh"]["method"].is_null());
    EXPECT_EQ(run({"info", "sheet.off"}).status, 0);
    EXPECT_NE(run({"info", "sheet.off", "--repaired", "none.off"}).status, 0);
}

TEST_F(CommandLine, InfoDescribesBallsAndAxes) {
    write(folder_ / "two.balls", "0 0 0 1\n1.5 0 0 2\n1.5 0 0 2\n");
    const Json balls = Json::parse(run({"info", "two.balls", "--json"}).out);
    EXPECT_EQ(balls["kind"], "balls");
    EXPECT_EQ(balls["balls"]["balls"], 3);
    EXPECT_EQ(balls["balls"]["distinct"], 2);
    EXPECT_EQ(balls["balls"]["radius"], (Json{{"min", 1.0}, {"max", 2.0}}));
    EXPECT_EQ(balls["balls"]["bounds"]["min"], (Json{-1.0, -2.0, -2.0}));

    for (const std::string axis : {"axis.ply", "axis.ma"}) {
        ASSERT_EQ(run({"medial", "two.balls", "-o", axis, "-q"}).status, 0);
        const Json document = Json::parse(run({"info", axis, "--json"}).out);
        EXPECT_EQ(document["kind"], "axis") << axis;
        const Json& found = document["axis"];
        EXPECT_EQ(found["vertices"], 2) << axis;
        EXPECT_EQ(found["edges"], 1) << axis;
        EXPECT_EQ(found["faces"], 0) << axis;
        EXPECT_EQ(found["sheets"], 0) << axis;
        EXPECT_EQ(found["topology"], (Json{{"components", 1}, {"euler", 1}, {"tunnels", 0}, {"voids", 0}})) << axis;
        EXPECT_NEAR(found["radius"]["max"].get<double>(), 2.0, 0.01) << axis;
        EXPECT_TRUE(contains(run({"info", axis}).out, "2 vertices, 1 edge, 0 faces, 0 sheets")) << axis;
    }
    ASSERT_EQ(run({"balls", "box.off", "-o", "balls.ply", "--delta", "0.1", "-q"}).status, 0);
    EXPECT_EQ(Json::parse(run({"info", "balls.ply", "--json"}).out)["kind"], "balls");
}

TEST_F(CommandLine, InfoFailsOnAFileThatCannotBeRead) {
    write(folder_ / "torn.ma", "2 1 0\nv 0 0 0 1\nv 1 0 0 1\n");
    for (const std::string file : {"missing.obj", "torn.ma"}) {
        const Outcome outcome = run({"info", file});
        EXPECT_EQ(outcome.status, 3);
        expect_error_line(outcome, file);
    }
}

/// Points on the unit sphere, with normals.
std::string sphere_points(int count) {
    std::ostringstream text;
    for (int i = 0; i < count; ++i) {
        const double z = 1.0 - (2.0 * i + 1.0) / count;
        const double r = std::sqrt(1.0 - z * z);
        const double angle = 2.399963229728653 * i;  // the golden angle
        for (int k = 0; k < 2; ++k) {
            text << r * std::cos(angle) << ' ' << r * std::sin(angle) << ' ' << z << (k == 0 ? ' ' : '\n');
        }
    }
    return text.str();
}

TEST_F(CommandLine, PointsBecomeASolid) {
    write(folder_ / "ball.xyz", sphere_points(2000));
    for (const std::string method : {"auto", "mls", "crust"}) {
        Arguments arguments{"axis", "ball.xyz", "--points", method, "-o", "axis.ply", "--stats", "-"};
        if (method != "crust") {
            arguments.insert(arguments.end(), {"--delta", "0.02"});
        }
        const Outcome outcome = run(arguments);
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        const Json document = Json::parse(outcome.out);
        EXPECT_EQ(document["options"]["input"]["points"], method);
        const Json& result = document["results"][0];
        EXPECT_EQ(result["points"]["points"], 2000);
        EXPECT_EQ(result["points"]["has_normals"], true);
        EXPECT_EQ(result["points"]["method"]["name"], method == "crust" ? "crust" : "mls");
        EXPECT_EQ(result["axes"][0]["dual_complex"]["topology"]["euler"], 1);
        EXPECT_EQ(result["axes"][0]["agreement"]["dual_and_medial"], true);
    }
    EXPECT_EQ(run({"balls", "ball.xyz", "--points", "crust", "-o", "balls.ply", "-q"}).status, 0);
    EXPECT_EQ(run({"axis", "ball.xyz", "--kernel", "4", "-o", "axis.ply", "-q"}).status, 0);
    EXPECT_EQ(run({"axis", "ball.xyz", "--kernel", "1", "-o", "axis.ply"}).status, 2);
    EXPECT_EQ(run({"axis", "ball.xyz", "--points", "best", "-o", "axis.ply"}).status, 2);
}

TEST_F(CommandLine, InfoDescribesPoints) {
    write(folder_ / "ball.xyz", sphere_points(500) + "1 0 0 1 0 0\n1 0 0 1 0 0\nnan nan nan 1 0 0\n");
    const Json document = Json::parse(run({"info", "ball.xyz", "--json"}).out);
    EXPECT_EQ(document["kind"], "points");
    EXPECT_EQ(document["points"]["points"], 503);
    EXPECT_EQ(document["points"]["not_finite"], 1);
    EXPECT_EQ(document["points"]["duplicates"], 1);
    EXPECT_TRUE(document["points"]["fault"].is_null());
    EXPECT_TRUE(contains(run({"info", "ball.xyz"}).out, "moving least squares: the points have normals"));
    // The vertices of a mesh, if they are asked for.
    const Json corners = Json::parse(run({"info", "box.off", "--as", "points", "--json"}).out);
    EXPECT_EQ(corners["points"]["points"], 8);
}

TEST_F(CommandLine, PointsThatBoundNoSolidAreRefused) {
    write(folder_ / "few.xyz", "0 0 0.5\n1 0 0\n0 1 0\n");
    write(folder_ / "flat.xyz", "0 0 0.5\n1 0 0.5\n0 1 0.5\n1 1 0.5\n3 4 0.5\n");
    for (const auto& [file, status, part] :
         {std::tuple{"few.xyz", 4, "3 different points"}, std::tuple{"flat.xyz", 4, "plane"}}) {
        const Outcome outcome = run({"axis", file, "-o", "axis.ply"});
        EXPECT_EQ(outcome.status, status) << file;
        expect_error_line(outcome, file);
        EXPECT_TRUE(contains(outcome.err, part)) << outcome.err;
        EXPECT_FALSE(fs::exists(folder_ / "axis.ply"));
    }
    const Outcome info = run({"info", "flat.xyz"});
    EXPECT_EQ(info.status, 0);
    EXPECT_TRUE(contains(info.out, "plane")) << info.out;
}

}  // namespace
