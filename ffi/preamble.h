/* wovenfit: from a scanned limb, a fabric's stiffness and wanted normal pressures to the flat pattern
 * of an elastic brace.
 *
 * This file is generated from the Rust sources of the library (ffi/); do not edit it.
 *
 * CONVENTIONS. They hold for every function and are not repeated there.
 *
 * Versions. Call wovenfit_check_abi(WOVENFIT_ABI_VERSION, &error) first. A library of another ABI
 *   number refuses, naming both.
 * Status. Functions return a wovenfit_status: 0 (WOVENFIT_STATUS_OK) is success. The numbers are
 *   frozen; new ones may come, so treat those that you do not know as failures.
 * Errors. The last argument, `error`, may be NULL. Else *error becomes NULL on success and a new
 *   object on failure, with a text for people that says what, where and what to do; free it with
 *   wovenfit_error_free. Nothing is kept in a global or per-thread "last error".
 * Outputs are written only on success, but for two: *error, and the count of a buffer that is too
 *   small.
 * Objects are opaque. What a function gives through a pointer to a pointer is the caller's, to be
 *   freed once with that type's own _free; freeing NULL is fine. Objects stand alone: any may be
 *   freed, in any order, as soon as the caller needs it no more.
 * Buffers. Inputs are copied and never kept. To get an array or a text, call with `buffer` NULL and
 *   `capacity` 0: the count says how much there is. Call again with a buffer of at least that
 *   capacity; a smaller one gives WOVENFIT_STATUS_BUFFER_TOO_SMALL, the count, and nothing else.
 *   Counts and capacities are in elements (numbers, bytes of a text), never in bytes of a number.
 *   Neither inputs nor buffers need an alignment. Buffers must not overlap.
 * Texts are UTF-8. Given ones end with NUL. Those got are followed by a NUL that their count and
 *   capacity include.
 * Pointers that must not be NULL are checked (WOVENFIT_STATUS_NULL_ARGUMENT). That they point to as
 *   much as is said cannot be.
 * Choices ("`what` is a wovenfit_...") are passed as int32_t, so that a number that the library does
 *   not know is refused and no undefined behaviour.
 * Units. Coordinates given are in the unit stated with the object that takes them, as a number of
 *   millimetres. All that comes back is in mm, kPa, N/mm, N mm and strains without unit. Indices
 *   count from 0. NaN is given where there is no value.
 * Threads. Each function says which thread may call it. "Any thread" means: several at once, on the
 *   same object too. A job and a check use worker threads of their own, as many as the machine has
 *   cores; they have ended when the call or the job has. The environment's RAYON_NUM_THREADS sets
 *   another number. Results do not depend on it.
 * Faults. No Rust panic and no C++ exception crosses this boundary: a fault of the library is
 *   WOVENFIT_STATUS_INTERNAL with its text.
 * Limits are stated below (WOVENFIT_MOST_...) and refused with WOVENFIT_STATUS_TOO_LARGE.
 * Unload the library only after every job was freed.
 */
