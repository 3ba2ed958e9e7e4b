// SPDX-License-Identifier: Apache-2.0
#include "expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <utility>

#include "base/angles.hpp"
#include "base/powers.hpp"
#include "base/tasks.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::app {

namespace {

/// Powers by an operator of our own; columns stay as they are.
constexpr const char* kPower = "~";
std::string with_own_powers(std::string expression) {
    for (std::size_t i = expression.find("**"); i != std::string::npos; i = expression.find("**", i)) {
        expression.replace(i, 2, "^ ");
    }
    std::ranges::replace(expression, '^', *kPower);
    return expression;
}

// Functions that are the same on all platforms.

double tangent(double x) {
    const auto [cosine, sine] = at_angle(x);
    return sine / cosine;
}

double arsinh(double x) {
    const double part = std::abs(x) / std::sqrt(1.0 + x * x);
    const double size = part < 0.2 ? small_artanh(part) : logarithm(std::abs(x) + std::sqrt(1.0 + x * x));
    return std::copysign(size, x);
}

double artanh(double x) { return std::abs(x) < 0.2 ? small_artanh(x) : 0.5 * logarithm((1.0 + x) / (1.0 - x)); }

double hyperbolic_sine(double x) {
    if (std::abs(x) > 1.0) {
        return 0.5 * (exponential(x) - exponential(-x));
    }
    double sum = 1.0;
    for (int k = 18; k > 0; k -= 2) {  // powers above are below the last bit
        sum = 1.0 + x * x / (k * (k + 1)) * sum;
    }
    return x * sum;
}

double hyperbolic_cosine(double x) { return 0.5 * (exponential(x) + exponential(-x)); }

double hyperbolic_tangent(double x) {
    return std::abs(x) > 20.0 ? std::copysign(1.0, x) : hyperbolic_sine(x) / hyperbolic_cosine(x);  // 1 - 1e-17
}

double arc_cosine(double x) { return std::abs(x) <= 1.0 ? angle_of_cosine(x) : std::nan(""); }

double arc_sine(double x) {
    return std::abs(x) <= 1.0 ? signed_angle_of(std::sqrt((1.0 - x) * (1.0 + x)), x) : std::nan("");
}

double binary_logarithm(double x) {
    int twos = 0;
    const double part = std::frexp(x, &twos);
    return part == 0.5 ? twos - 1.0 : logarithm(x) / std::numbers::ln2;  // powers of two exactly
}

/// A parser and the variables that it reads: for one thread.
class Evaluator {
   public:
    explicit Evaluator(const std::string& expression) {
        parser_.DefineVar("x", &p_.x);
        parser_.DefineVar("y", &p_.y);
        parser_.DefineVar("z", &p_.z);
        parser_.DefineConst("pi", std::numbers::pi);
        using Of1 = double (*)(double);
        using Of2 = double (*)(double, double);
        for (const auto& [name, f] : std::initializer_list<std::pair<const char*, Of1>>{
                 {"sin", [](double a) { return at_angle(a)[1]; }},
                 {"cos", cosine_of},
                 {"tan", tangent},
                 {"asin", arc_sine},
                 {"acos", arc_cosine},
                 {"atan", [](double a) { return signed_angle_of(1.0, a); }},
                 {"sinh", hyperbolic_sine},
                 {"cosh", hyperbolic_cosine},
                 {"tanh", hyperbolic_tangent},
                 {"asinh", arsinh},
                 {"acosh", [](double a) { return logarithm(a + std::sqrt(a * a - 1.0)); }},
                 {"atanh", artanh},
                 {"log2", binary_logarithm},
                 {"log10", [](double a) { return logarithm(a) / std::numbers::ln10; }},
                 {"log", logarithm},
                 {"ln", logarithm},
                 {"exp", exponential},
                 {"floor", [](double a) { return std::floor(a); }},
                 {"ceil", [](double a) { return std::ceil(a); }}}) {
            parser_.DefineFun(name, f);
        }
        for (const auto& [name, f] : std::initializer_list<std::pair<const char*, Of2>>{
                 {"pow", power},
                 {"atan2", [](double a, double b) { return signed_angle_of(b, a); }},
                 {"fmod", [](double a, double b) { return std::fmod(a, b); }},
                 {"mod", [](double a, double b) { return a - b * std::floor(a / b); }},
                 {"hypot", [](double a, double b) { return std::sqrt(a * a + b * b); }}}) {
            parser_.DefineFun(name, f);
        }
        parser_.DefineOprt(kPower, power, mu::prPOW, mu::oaRIGHT);
        parser_.SetExpr(with_own_powers(expression));
    }
    Evaluator(const Evaluator&) = delete;
    Evaluator& operator=(const Evaluator&) = delete;

    double value(const Point& p) {
        p_ = p;
        return parser_.Eval();
    }
    int results() {
        int count = 0;
        parser_.Eval(count);
        return count;
    }

   private:
    Point p_;
    mu::Parser parser_;
};

/// Where there is an `=` that does not compare; `npos` if nowhere.
std::size_t assignment_in(const std::string& expression) {
    for (std::size_t i = 0; i < expression.size(); ++i) {
        if (expression[i] == '=') {
            if (i + 1 == expression.size() || expression[i + 1] != '=') {
                return i;
            }
            ++i;
        } else if (std::string_view("<>!").find(expression[i]) != std::string_view::npos) {
            i += i + 1 < expression.size() && expression[i + 1] == '=' ? 1 : 0;
        }
    }
    return std::string::npos;
}

}  // namespace

std::function<double(const Point&)> compiled(const std::string& expression) {
    if (const std::size_t at = assignment_in(expression); at != std::string::npos) {
        throw InvalidOption("--implicit \"" + expression + "\", column " + std::to_string(at + 1) +
                            ": an assignment, which has no meaning here; == compares");
    }
    if (const std::size_t at = expression.find(kPower); at != std::string::npos) {
        throw InvalidOption("--implicit \"" + expression + "\", column " + std::to_string(at + 1) + ": " + kPower +
                            " has no meaning here; powers are written ^ or **");
    }
    try {
        if (Evaluator(expression).results() != 1) {
            throw InvalidOption("--implicit \"" + expression +
                                "\": a comma outside of a function; one value is needed");
        }
    } catch (const mu::Parser::exception_type& error) {
        std::string message = error.GetMsg();
        std::ranges::replace(message, *kPower, '^');
        message = message.substr(0, message.find(" at position"));  // counted from 0
        while (message.ends_with('.') || message.ends_with('\n')) {
            message.pop_back();
        }
        const std::size_t column =
            std::min<std::size_t>(std::max(0, static_cast<int>(error.GetPos())), expression.size()) + 1;
        throw InvalidOption("--implicit \"" + expression + "\", column " + std::to_string(column) + ": " + message);
    }
    const auto evaluators = std::make_shared<tasks::enumerable_thread_specific<std::unique_ptr<Evaluator>>>(
        [expression] { return std::make_unique<Evaluator>(expression); });
    return [evaluators](const Point& p) { return evaluators->local()->value(p); };
}

}  // namespace scaleaxis::app
