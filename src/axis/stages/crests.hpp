// SPDX-License-Identifier: Apache-2.0
/// \file
/// Where narrow sheets lead to curves in place of wider sheets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "axis/edit/remainder.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

/// The vertices of narrow sheets that are to stay as curves when these sheets vanish: 1, else 0.
///
/// Up a sheet radii grow with the cosine of its object angle. It ends at a wider one, as those into the chamfered edges
/// of a plate at its middle: then balls of the wider one, larger by 1 / cosine, cover all that goes, and so much of the
/// solid may be lost. Or it ends at a crest, from which others lead down, too, as in a bar with six sides: then nothing
/// else stands for the bar. Crests are vertices from which no edge leads steeply up, connected ones together, unless
/// balls that stay cover them.
///
/// \param is_narrow 1 for vertices of narrow sheets alone
/// \param cosine of the largest object angle of a narrow sheet
std::vector<std::uint8_t> crests_of_narrow_sheets(const MedialComplex& complex, std::span<const std::uint8_t> is_narrow,
                                                  double cosine);

/// Takes the hairs away that stand off curves which narrow sheets have become: ways to vertices that nothing covered
/// while these sheets were there, or while the curve had gaps. Those that the balls of other curves cover now go, the
/// smallest first.
///
/// \param is_narrow 1 for vertices that had faces of narrow sheets alone: what hangs there may be a hair
void remove_hairs(const MedialComplex& complex, std::span<const std::uint8_t> is_narrow, double cosine,
                  Remainder& remainder);

}  // namespace scaleaxis::inline v1
