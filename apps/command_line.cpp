// SPDX-License-Identifier: Apache-2.0
#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>

#include "inputs.hpp"

namespace scaleaxis::app {

TextCheck is_one_of(std::vector<std::string> texts) { return CLI::IsMember(std::move(texts)); }

bool parse_value(const std::string& text, double& value) { return CLI::detail::lexical_cast(text, value); }

Option Option::required(bool is_required) const { return option_->required(is_required); }

Option Option::check(const TextCheck& check) const { return option_->check(CLI::Validator(check, "")); }

Option Option::transform(const TextCheck& change) const { return option_->transform(CLI::Validator(change, "")); }

Option Option::excludes(Option other) const { return option_->excludes(other.option_); }

Option Option::needs(Option other) const { return option_->needs(other.option_); }

Option Option::delimiter(char separator) const { return option_->delimiter(separator); }

Option Option::one_text_each() const { return option_->allow_extra_args(false); }

Option Option::expected(int count) const { return option_->expected(count); }

Option Option::value_text(const std::string& text) const { return option_->option_text(text); }

Option Option::group(const std::string& heading) const { return option_->group(heading); }

std::size_t Option::count() const { return option_->count(); }

CommandLine CommandLine::add_subcommand(const std::string& name, const std::string& description) const {
    return *app_->add_subcommand(name, description);
}

namespace {

template <class Value>
constexpr bool kIsInput = false;
template <>
constexpr bool kIsInput<std::filesystem::path> = true;
template <>
constexpr bool kIsInput<std::optional<std::filesystem::path>> = true;
template <>
constexpr bool kIsInput<std::vector<std::filesystem::path>> = true;

}  // namespace

template <class Value>
Option CommandLine::add_option(const std::string& names, Value& value, const std::string& description) const {
    CLI::Option* const option = app_->add_option(names, value, description);
    if constexpr (kIsInput<Value>) {
        option->each([](const std::string& text) { protect_input(text); });
    }
    return option;
}

template <class Value>
Option CommandLine::add_option_function(const std::string& names, const std::function<void(const Value&)>& set,
                                        const std::string& description) const {
    return app_->add_option_function<Value>(names, set, description);
}

#define SCALEAXIS_OPTIONS_OF(...) \
    template Option CommandLine::add_option(const std::string&, __VA_ARGS__&, const std::string&) const;
SCALEAXIS_OPTIONS_OF(int)
SCALEAXIS_OPTIONS_OF(std::uint64_t)
SCALEAXIS_OPTIONS_OF(double)
SCALEAXIS_OPTIONS_OF(std::string)
SCALEAXIS_OPTIONS_OF(std::filesystem::path)
SCALEAXIS_OPTIONS_OF(std::optional<int>)
SCALEAXIS_OPTIONS_OF(std::optional<double>)
SCALEAXIS_OPTIONS_OF(std::optional<std::filesystem::path>)
SCALEAXIS_OPTIONS_OF(std::vector<int>)
SCALEAXIS_OPTIONS_OF(std::vector<float>)
SCALEAXIS_OPTIONS_OF(std::vector<double>)
SCALEAXIS_OPTIONS_OF(std::vector<std::string>)
SCALEAXIS_OPTIONS_OF(std::vector<std::filesystem::path>)
SCALEAXIS_OPTIONS_OF(std::vector<std::array<double, 3>>)
#undef SCALEAXIS_OPTIONS_OF
template Option CommandLine::add_option_function(const std::string&, const std::function<void(const double&)>&,
                                                 const std::string&) const;
template Option CommandLine::add_option_function(const std::string&, const std::function<void(const std::string&)>&,
                                                 const std::string&) const;

Option CommandLine::add_flag(const std::string& names, bool& value, const std::string& description) const {
    return app_->add_flag(names, value, description);
}

Option CommandLine::add_flag_callback(const std::string& names, const std::function<void()>& set,
                                      const std::string& description) const {
    return app_->add_flag_callback(names, set, description);
}

Option CommandLine::option(const std::string& name) const { return app_->get_option(name); }

void CommandLine::footer(const std::string& text) const { app_->footer(text); }

void CommandLine::on_parsed(const std::function<void()>& action) const { app_->parse_complete_callback(action); }

std::string CommandLine::name() const { return app_->get_name(); }

bool CommandLine::is_parsed() const { return app_->parsed(); }

std::vector<std::string> CommandLine::given_options(const std::string& group) const {
    std::vector<std::string> names;
    for (const CLI::Option* option : app_->get_options()) {
        if (option->get_group() == group && option->count() > 0) {
            names.push_back(option->get_name());
        }
    }
    return names;
}

}  // namespace scaleaxis::app
