// SPDX-License-Identifier: GPL-3.0-or-later
// The medial axis of two balls that overlap is the segment between their centres.
#include <scaleaxis/medial_axis.hpp>
#include <vector>

int main() {
    const std::vector<scaleaxis::Ball> balls{{{0, 0, 0}, 1}, {{1, 0, 0}, 1}};
    const scaleaxis::MedialAxis axis = scaleaxis::medial_axis(balls);
    return axis.complex.edges.size() == 1 && axis.complex.faces.empty() ? 0 : 1;
}
