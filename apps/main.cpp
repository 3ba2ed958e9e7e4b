// SPDX-License-Identifier: Apache-2.0
#include "interrupts.hpp"
#include "outputs.hpp"
#include "program.hpp"
#include "scaleaxis/execution.hpp"
#include "terminal.hpp"

int main(int argc, char** argv) {
    const std::stop_token cancel = scaleaxis::app::catch_interrupts();
    scaleaxis::app::ignore_file_size_signal();
    scaleaxis::app::prepare_streams();
    scaleaxis::keep_freed_memory();
    return scaleaxis::app::run_program(argc, argv, cancel);
}
