// SPDX-License-Identifier: Apache-2.0
// first_axis MESH AXIS: the discrete scale axis of a closed mesh, with the library. The README shows this, too.

#include <iostream>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"

int main(int argc, char** argv) try {
    const auto solid = scaleaxis::mesh_solid(scaleaxis::read_mesh(argv[argc - 2]));
    const scaleaxis::ScaleAxis result =
        scaleaxis::scale_axis(*solid, {.delta = scaleaxis::Length::relative(0.02), .scales = {1.1}});
    scaleaxis::write_axis(argv[argc - 1], result.axes[0].complex);
    std::cout << result.balls.size() << " balls, " << result.axes[0].complex.faces.size() << " faces\n";
} catch (const scaleaxis::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
