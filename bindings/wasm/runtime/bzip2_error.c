// SPDX-License-Identifier: Apache-2.0
// What bzip2 calls where it finds a fault of its own, if it has no stdio.
void bz_internal_error(int code) {
    (void)code;
    __builtin_trap();
}
