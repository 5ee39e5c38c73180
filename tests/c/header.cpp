// The header as C++17: it compiles without a warning, and its functions link as C.

#include <cstdint>
#include <cstdio>
#include <type_traits>

#include "wovenfit.h"

static_assert(std::is_same<decltype(&wovenfit_abi_version), std::uint32_t (*)()>::value, "C linkage");
static_assert(sizeof(wovenfit_status) == 4 && sizeof(wovenfit_job_progress) == 24, "layout");
static_assert(sizeof(wovenfit_pressure) == 112 && sizeof(wovenfit_result_summary) == 72, "layout");

int main() {
    wovenfit_error *error = nullptr;
    const wovenfit_status status = wovenfit_check_abi(WOVENFIT_ABI_VERSION, &error);
    std::printf("wovenfit %s\n", wovenfit_version());
    return status == WOVENFIT_STATUS_OK && error == nullptr ? 0 : 1;
}
