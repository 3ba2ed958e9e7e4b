// SPDX-License-Identifier: Apache-2.0
#include "solid/zero_set/bracketed_root.hpp"

#include "base/text.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::inline v1 {

void check_bracket(double begin, double end, double value_at_begin, double value_at_end) {
    const bool has_signs =
        (value_at_begin <= 0.0 && value_at_end >= 0.0) || (value_at_begin >= 0.0 && value_at_end <= 0.0);
    if (!(begin <= end) || !has_signs) {
        Words text;
        text << "the surface cannot be found between two places: the values there, " << value_at_begin << " and "
             << value_at_end << ", should be on different sides of 0";
        throw UnusableInput(Diagnostic{"zero_set.bracket", text.str()});
    }
}

RootFinder::RootFinder(double begin, double end, double value_at_begin, double value_at_end, double accuracy)
    : begin_(begin), end_(end), value_at_begin_(value_at_begin), value_at_end_(value_at_end), accuracy_(accuracy) {
    run();
}

void RootFinder::tell(double value) {
    values_.push_back(value);
    run();
}

void RootFinder::run() {
    std::size_t next = 0;
    is_found_ = true;
    const auto value_at = [&](double t) {
        if (next < values_.size()) {
            return values_[next++];
        }
        is_found_ = false;
        place_ = t;
        return 0.0;
    };
    root_ = bracketed_root(value_at, begin_, end_, value_at_begin_, value_at_end_, accuracy_);
}

}  // namespace scaleaxis::inline v1
