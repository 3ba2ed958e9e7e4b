// SPDX-License-Identifier: Apache-2.0
#include "expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "base/tasks.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::app {

namespace {

/// The same power for muparser, whose own operator it is; columns stay as they are.
std::string with_carets(std::string expression) {
    for (std::size_t i = expression.find("**"); i != std::string::npos; i = expression.find("**", i)) {
        expression.replace(i, 2, "^ ");
    }
    return expression;
}

/// A parser and the variables that it reads: for one thread.
class Evaluator {
   public:
    explicit Evaluator(const std::string& expression) {
        parser_.DefineVar("x", &p_.x);
        parser_.DefineVar("y", &p_.y);
        parser_.DefineVar("z", &p_.z);
        parser_.DefineConst("pi", std::numbers::pi);
        const auto function = [this](const char* name, double (*f)(double, double)) { parser_.DefineFun(name, f); };
        function("pow", [](double a, double b) { return std::pow(a, b); });
        function("fmod", [](double a, double b) { return std::fmod(a, b); });
        function("mod", [](double a, double b) { return a - b * std::floor(a / b); });
        function("hypot", [](double a, double b) { return std::hypot(a, b); });
        parser_.DefineFun(
            "floor", +[](double a) { return std::floor(a); });
        parser_.DefineFun(
            "ceil", +[](double a) { return std::ceil(a); });
        parser_.SetExpr(with_carets(expression));
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
    try {
        if (Evaluator(expression).results() != 1) {
            throw InvalidOption("--implicit \"" + expression +
                                "\": a comma outside of a function; one value is needed");
        }
    } catch (const mu::Parser::exception_type& error) {
        std::string message = error.GetMsg();
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
