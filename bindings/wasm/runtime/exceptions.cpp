// SPDX-License-Identifier: Apache-2.0
// C++ exceptions of WebAssembly: the part of the Itanium ABI that Debian's libc++abi for wasm32-wasi leaves out.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <typeinfo>

namespace {

/// What precedes a thrown object. `unwind` is what the engine carries.
struct alignas(16) Header {
    std::type_info* type;
    void* (*destroy)(void*);  ///< destructors of wasm return their object
    Header* next_caught;
    void* adjusted;
    int handlers;  ///< negative: thrown again
    char unwind;
};

Header* caught = nullptr;
int uncaught = 0;

Header* of_unwind(void* unwind) {
    return reinterpret_cast<Header*>(static_cast<char*>(unwind) - offsetof(Header, unwind));
}
void* object_of(Header* h) { return h + 1; }

/// The virtual functions of libc++abi's `__shim_type_info`.
class Type : public std::type_info {
   public:
    virtual ~Type();
    virtual void noop1() const;
    virtual void noop2() const;
    virtual bool can_catch(const Type* thrown, void*& adjusted) const = 0;
};

std::uintptr_t uleb(const std::uint8_t*& p) {
    std::uintptr_t v = 0;
    for (unsigned shift = 0;; shift += 7) {
        const std::uint8_t b = *p++;
        v |= std::uintptr_t(b & 0x7f) << shift;
        if (!(b & 0x80)) return v;
    }
}
std::intptr_t sleb(const std::uint8_t*& p) {
    std::uintptr_t v = 0;
    unsigned shift = 0;
    std::uint8_t b;
    do {
        b = *p++;
        v |= std::uintptr_t(b & 0x7f) << shift;
        shift += 7;
    } while (b & 0x80);
    if ((b & 0x40) && shift < 8 * sizeof(v)) v |= ~std::uintptr_t(0) << shift;
    return static_cast<std::intptr_t>(v);
}

}  // namespace

extern "C" {

/// Compiled code fills the first two before it asks for the third.
struct {
    std::uintptr_t pad;
    const std::uint8_t* table;
    std::uintptr_t selector;
} __wasm_lpad_context;

int _Unwind_CallPersonality(void* unwind) {
    Header* h = of_unwind(unwind);
    auto& c = __wasm_lpad_context;
    c.selector = 0;
    const std::uint8_t* p = c.table;
    if (!p) return 8;
    if (*p++ != 0xff) uleb(p);  // never written for wasm
    const void* const* types = nullptr;
    if (*p++ != 0xff) {
        const std::uintptr_t offset = uleb(p);
        types = reinterpret_cast<const void* const*>(p + offset);
    }
    ++p;  // encoding of call sites
    const std::uintptr_t length = uleb(p);
    const std::uint8_t* sites = p;
    const std::uint8_t* actions = p + length;
    std::uintptr_t action = 0;
    for (std::uintptr_t i = 0; i <= c.pad; ++i) {
        uleb(sites);
        action = uleb(sites);
    }
    if (!action) return 8;
    for (const std::uint8_t* a = actions + action - 1;;) {
        const std::intptr_t filter = sleb(a);
        const std::uint8_t* at = a;
        const std::intptr_t next = sleb(a);
        if (filter > 0) {
            const auto* type = static_cast<const Type*>(static_cast<const std::type_info*>(types[-filter]));
            void* adjusted = object_of(h);
            if (!type || type->can_catch(static_cast<const Type*>(h->type), adjusted)) {
                h->adjusted = adjusted;
                c.selector = static_cast<std::uintptr_t>(filter);
                return 6;
            }
        }
        if (!next) return 8;
        a = at + next;
    }
}

void* __cxa_allocate_exception(std::size_t size) noexcept {
    auto* h = static_cast<Header*>(std::malloc(sizeof(Header) + size));
    if (!h) std::terminate();
    *h = {};
    return h + 1;
}
void __cxa_free_exception(void* object) noexcept { std::free(static_cast<Header*>(object) - 1); }

[[noreturn]] void __cxa_throw(void* object, std::type_info* type, void* (*destroy)(void*)) {
    Header* h = static_cast<Header*>(object) - 1;
    h->type = type;
    h->destroy = destroy;
    h->adjusted = object;
    ++uncaught;
    __builtin_wasm_throw(0, &h->unwind);
}

void* __cxa_get_exception_ptr(void* unwind) noexcept { return of_unwind(unwind)->adjusted; }

void* __cxa_begin_catch(void* unwind) noexcept {
    Header* h = of_unwind(unwind);
    h->handlers = h->handlers < 0 ? -h->handlers + 1 : h->handlers + 1;
    if (caught != h) {
        h->next_caught = caught;
        caught = h;
    }
    --uncaught;
    return h->adjusted;
}

void __cxa_end_catch() {
    Header* h = caught;
    if (!h) return;
    if (h->handlers < 0) {  // thrown again: lives on
        if (++h->handlers == 0) caught = h->next_caught;
    } else if (--h->handlers == 0) {
        caught = h->next_caught;
        if (h->destroy) h->destroy(object_of(h));
        std::free(h);
    }
}

[[noreturn]] void __cxa_rethrow() {
    Header* h = caught;
    if (!h) std::terminate();
    h->handlers = -h->handlers;
    ++uncaught;
    __builtin_wasm_throw(0, &h->unwind);
}

// std::exception_ptr, which nothing here uses.
void __cxa_increment_exception_refcount(void*) noexcept { std::abort(); }
void __cxa_decrement_exception_refcount(void* p) noexcept {
    if (p) std::abort();
}
void* __cxa_current_primary_exception() noexcept { return nullptr; }
void __cxa_rethrow_primary_exception(void*) { std::abort(); }
// A reactor never ends: its thread-local objects live as long as it does.
int __cxa_thread_atexit(void (*)(void*), void*, void*) noexcept { return 0; }
int __cxa_uncaught_exceptions() noexcept { return uncaught; }
bool __cxa_uncaught_exception() noexcept { return uncaught > 0; }
}

// libc++abi was built without exceptions: its `operator new` ends the program where memory ends.
#include <new>
void* operator new(std::size_t size) {
    if (void* p = std::malloc(size ? size : 1)) return p;
    throw std::bad_alloc();
}
void* operator new[](std::size_t size) { return operator new(size); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
