// SPDX-License-Identifier: Apache-2.0
#include "manual.hpp"

#include <algorithm>
#include <functional>
#include <sstream>
#include <string_view>
#include <vector>

#include "scaleaxis/version.hpp"

namespace scaleaxis::app {

namespace {

std::vector<const CLI::App*> subcommands_of(const CLI::App& program) {
    return program.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> options_of(const CLI::App& command, bool is_positional) {
    return command.get_options([is_positional](const CLI::Option* option) {
        return !option->get_group().empty() && option->get_positional() == is_positional;
    });
}

/// The value of an option as the help shows it; empty for flags.
std::string value_of(const CLI::Option& option) {
    const std::string text = option.get_option_text();
    return text == " " ? std::string() : text;
}

/// Text for roff: backslashes, hyphens that users copy, and lines that would be requests.
std::string escaped(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool begins_line = i == 0 || text[i - 1] == '\n';
        if (begins_line && (text[i] == '.' || text[i] == '\'')) {
            result += "\\&";
        }
        if (text[i] == '\\') {
            result += "\\e";
        } else if (text[i] == '-') {
            result += "\\-";
        } else {
            result += text[i];
        }
    }
    return result;
}

/// The names of an option, the short ones first: "-o, --output".
std::string names_of(const CLI::Option& option) {
    std::string names;
    for (const std::string& name : option.get_snames()) {
        names += (names.empty() ? "-" : ", -") + name;
    }
    for (const std::string& name : option.get_lnames()) {
        names += (names.empty() ? "--" : ", --") + name;
    }
    return names;
}

void write_items(std::ostream& out, const CLI::App& command, bool is_positional) {
    for (const CLI::Option* option : options_of(command, is_positional)) {
        const std::string name = is_positional ? option->get_name(true, false) : names_of(*option);
        out << ".TP\n\\fB" << escaped(name) << "\\fR";
        if (const std::string value = value_of(*option); !value.empty()) {
            out << " \\fI" << escaped(value) << "\\fR";
        }
        out << '\n' << escaped(option->get_description()) << '\n';
    }
}

std::string words_of(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) {
        text += (text.empty() ? "" : " ") + word;
    }
    return text;
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : options_of(command, false)) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
        for (const std::string& name : option->get_snames()) {
            names.push_back("-" + name);
        }
    }
    return names;
}

/// The values to choose from, of an option that is shown as `a|b|c`.
std::string choices_of(const CLI::Option& option) {
    std::string text = value_of(option);
    if (text.find('|') == std::string::npos) {
        return {};
    }
    std::ranges::replace(text, '|', ' ');
    return text;
}

std::vector<std::string> names_of_subcommands(const CLI::App& program) {
    std::vector<std::string> names;
    for (const CLI::App* command : subcommands_of(program)) {
        names.push_back(command->get_name());
    }
    return names;
}

std::string bash_completion(const CLI::App& program) {
    std::ostringstream out;
    out << "# Completion of scaleaxis for bash, made by scaleaxis --completion bash.\n"
           "_scaleaxis() {\n"
           "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} options=\n"
           "    if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
           "        COMPREPLY=($(compgen -W '"
        << words_of(names_of_subcommands(program)) << ' ' << words_of(option_names(program))
        << "' -- \"$word\"))\n"
           "        return\n"
           "    fi\n"
           "    case \"${COMP_WORDS[1]}$before\" in\n";
    for (const CLI::App* command : subcommands_of(program)) {
        for (const CLI::Option* option : options_of(*command, false)) {
            if (const std::string choices = choices_of(*option); !choices.empty()) {
                out << "        " << command->get_name() << "--" << option->get_lnames().front()
                    << ") COMPREPLY=($(compgen -W '" << choices << "' -- \"$word\")); return ;;\n";
            }
        }
    }
    out << "    esac\n"
           "    case \"${COMP_WORDS[1]}\" in\n";
    for (const CLI::App* command : subcommands_of(program)) {
        out << "        " << command->get_name() << ") options='" << words_of(option_names(*command)) << "' ;;\n";
    }
    out << "    esac\n"
           "    case \"$word\" in\n"
           "        -*) COMPREPLY=($(compgen -W \"$options\" -- \"$word\")) ;;\n"
           "        *) COMPREPLY=($(compgen -f -- \"$word\")) ;;\n"
           "    esac\n"
           "}\n"
           "complete -o filenames -F _scaleaxis scaleaxis\n";
    return out.str();
}

/// In single quotes, for zsh and fish.
std::string quoted(const std::string& text) {
    std::string line = text.substr(0, text.find('\n'));
    std::erase_if(line, [](char c) { return c == '\'' || c == '[' || c == ']' || c == ':'; });
    return "'" + line + "'";
}

std::string fish_completion(const CLI::App& program) {
    std::ostringstream out;
    out << "# Completion of scaleaxis for fish, made by scaleaxis --completion fish.\n";
    for (const CLI::App* command : subcommands_of(program)) {
        out << "complete -c scaleaxis -n __fish_use_subcommand -a " << command->get_name() << " -d "
            << quoted(command->get_description()) << '\n';
        for (const CLI::Option* option : options_of(*command, false)) {
            out << "complete -c scaleaxis -n '__fish_seen_subcommand_from " << command->get_name() << "'";
            for (const std::string& name : option->get_lnames()) {
                out << " -l " << name;
            }
            for (const std::string& name : option->get_snames()) {
                out << " -s " << name;
            }
            if (const std::string choices = choices_of(*option); !choices.empty()) {
                out << " -x -a '" << choices << "'";
            } else if (!value_of(*option).empty()) {
                out << " -r";
            }
            out << " -d " << quoted(option->get_description()) << '\n';
        }
    }
    return out.str();
}

std::string zsh_completion(const CLI::App& program) {
    std::ostringstream out;
    out << "#compdef scaleaxis\n"
           "# Completion of scaleaxis for zsh, made by scaleaxis --completion zsh.\n"
           "if (( CURRENT == 2 )); then\n"
           "    compadd -- "
        << words_of(names_of_subcommands(program)) << ' ' << words_of(option_names(program))
        << "\n"
           "    return\n"
           "fi\n"
           "case ${words[2]} in\n";
    for (const CLI::App* command : subcommands_of(program)) {
        out << "    " << command->get_name() << ") _arguments";
        for (const CLI::Option* option : options_of(*command, false)) {
            for (const std::string& name : option->get_lnames()) {
                const std::string choices = choices_of(*option);
                const std::string value = value_of(*option).empty() ? ""
                                          : choices.empty()         ? ":value:_files"
                                                                    : ":value:(" + choices + ")";
                const std::string about = quoted(option->get_description());
                out << " \\\n        '--" << name << '[' << about.substr(1, about.size() - 2) << ']' << value << "'";
            }
        }
        out << " \\\n        '*:file:_files' ;;\n";
    }
    out << "esac\n";
    return out.str();
}

}  // namespace

std::string manual_page(const CLI::App& program) {
    std::ostringstream out;
    out << ".TH SCALEAXIS 1 \"\" \"scaleaxis " SCALEAXIS_VERSION "\" \"User Commands\"\n"
        << ".SH NAME\nscaleaxis \\- discrete scale axis of 3D solids\n"
        << ".SH SYNOPSIS\n";
    for (const CLI::App* command : subcommands_of(program)) {
        out << ".B scaleaxis " << escaped(command->get_name()) << '\n';
        for (const CLI::Option* option : options_of(*command, true)) {
            out << ".I " << escaped(option->get_name(true, false)) << '\n';
        }
        out << "[\\fIOPTION\\fR...]\n.br\n";
    }
    out << ".SH DESCRIPTION\n" << escaped(program.get_description()) << '\n';
    write_items(out, program, false);
    for (const CLI::App* command : subcommands_of(program)) {
        out << ".SH scaleaxis " << escaped(command->get_name()) << '\n' << escaped(command->get_description()) << ".\n";
        write_items(out, *command, true);
        write_items(out, *command, false);
        if (const std::string footer = command->get_footer(); !footer.empty()) {
            out << ".PP\n.nf\n" << escaped(footer) << "\n.fi\n";
        }
    }
    out << ".SH NOTES\n.nf\n" << escaped(program.get_footer()) << "\n.fi\n";
    return out.str();
}

std::string completion(const CLI::App& program, const std::string& shell) {
    return shell == "bash"  ? bash_completion(program)
           : shell == "zsh" ? zsh_completion(program)
                            : fish_completion(program);
}

}  // namespace scaleaxis::app
