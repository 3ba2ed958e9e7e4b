// SPDX-License-Identifier: Apache-2.0
/// \file
/// Zeros of functions of one variable, by bracketing.
#pragma once

namespace scaleaxis {

/// Where a function crosses zero between `begin` and `end`, to within `accuracy`, or to machine precision. The values
/// at the ends are known, and either one of them is zero, or their signs differ. All others are told from outside, so
/// that many searches can go on together: until `is_found()`, `tell` the value at `place()`.
///
/// Algorithm 748 of the ACM (G. Alefeld, F. A. Potra, Y. Shi, "Algorithm 748: enclosing zeros of continuous functions",
/// 1995) in the variant of Boost.Math, step by step: about seven values for a smooth function.
class RootFinder {
   public:
    /// \throws UnusableInput unless the values at the ends are on different sides of zero
    RootFinder(double begin, double end, double value_at_begin, double value_at_end, double accuracy = 0.0);

    bool is_found() const { return is_found_; }
    double root() const { return root_; }

    /// Where the value is wanted.
    double place() const { return next_ - shift_; }
    void tell(double value);

    struct Sample {
        double place;
        double value;
    };

   private:
    enum class Step { kSecant, kQuadratic, kCubic, kSecondCubic, kDoubleSecant, kBisection };

    bool is_narrow() const { return b_.place - a_.place <= width_; }
    void finish(double root);
    void take(Step step);
    Step following() const;

    // The solver works on places that are moved by this.
    double shift_ = 0.0;
    double width_ = 0.0;
    Sample a_{};  // the ends of the bracket
    Sample b_{};
    Sample d_{};  // the end that was replaced last, and the one before
    Sample e_{};
    double width_of_round_ = 0.0;  // at its first cubic step
    double next_ = 0.0;
    Step step_ = Step::kSecant;
    int steps_left_ = 200;
    double root_ = 0.0;
    bool is_found_ = false;
};

/// The same of a function that can be called.
/// \throws UnusableInput as `RootFinder`
template <class Function>
double bracketed_root(const Function& function, double begin, double end, double value_at_begin, double value_at_end,
                      double accuracy = 0.0) {
    RootFinder finder(begin, end, value_at_begin, value_at_end, accuracy);
    while (!finder.is_found()) {
        finder.tell(function(finder.place()));
    }
    return finder.root();
}

}  // namespace scaleaxis
