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


#ifndef WOVENFIT_H
#define WOVENFIT_H

#include <stddef.h>
#include <stdint.h>

// Most vertices of a mesh: three for each of the most triangles, as a mesh without shared vertices
// has.
#define WOVENFIT_MOST_VERTICES 6000000

// Most triangles of a mesh. A limb scanned to half a millimetre has fewer; decimate beyond.
#define WOVENFIT_MOST_TRIANGLES 2000000

// Most wanted pressures of a design. Paint more onto the vertices instead.
#define WOVENFIT_MOST_PRESSURES 1000

// Most points of all seams of a design together.
#define WOVENFIT_MOST_SEAM_POINTS 5000

// Most planes of a region, and most bony places.
#define WOVENFIT_MOST_PLANES 1000

// Most bytes of a text given to the library.
#define WOVENFIT_MOST_TEXT 64000000

// No element: where an index could stand.
#define WOVENFIT_NONE UINT32_MAX

// The number of this ABI. It grows when a function or a struct changes so that an older caller
// would misread it; what is only added leaves it.
#define WOVENFIT_ABI_VERSION 1

// What a function returns: 0 is success, all else a reason.
enum wovenfit_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Done.
  WOVENFIT_STATUS_OK = 0,
  // A pointer that must not be NULL is.
  WOVENFIT_STATUS_NULL_ARGUMENT = 1,
  // An argument that cannot be: no number, out of its range, of the wrong length.
  WOVENFIT_STATUS_INVALID_ARGUMENT = 2,
  // The buffer holds less than there is; the count says how much that is.
  WOVENFIT_STATUS_BUFFER_TOO_SMALL = 3,
  // More than the library takes; the text states the limit.
  WOVENFIT_STATUS_TOO_LARGE = 4,
  // A text is not UTF-8.
  WOVENFIT_STATUS_NOT_UTF8 = 5,
  // The caller was made for another ABI number.
  WOVENFIT_STATUS_ABI_MISMATCH = 6,
  // The job has not got that far.
  WOVENFIT_STATUS_NOT_READY = 7,
  // The time to wait is over and the job runs.
  WOVENFIT_STATUS_TIMEOUT = 8,
  // The job was cancelled.
  WOVENFIT_STATUS_CANCELLED = 9,
  // No element has this index.
  WOVENFIT_STATUS_OUT_OF_RANGE = 10,
  // The design breaks a rule of the design file.
  WOVENFIT_STATUS_DESIGN = 20,
  // No parameter has this name, or it cannot take the value.
  WOVENFIT_STATUS_PARAMETER = 21,
  // The surface is broken; `wovenfit_check_run` lists every defect.
  WOVENFIT_STATUS_SURFACE = 22,
  // The surface is not of a limb's size in its unit.
  WOVENFIT_STATUS_UNIT = 23,
  // Region, seams or orientation are impossible.
  WOVENFIT_STATUS_SEAM = 24,
  // A wanted pressure lies off the surface or outside the region.
  WOVENFIT_STATUS_PRESSURE = 25,
  // The cut surface has no parameterization.
  WOVENFIT_STATUS_PARAMETERIZATION = 26,
  // The fit is impossible.
  WOVENFIT_STATUS_FIT = 27,
  // The fabric does not cover the surface.
  WOVENFIT_STATUS_MAPPING = 28,
  // The prepared limb is for another region, seams, facing, unit or parameter: start a job on the
  // mesh instead.
  WOVENFIT_STATUS_PREPARED_FOR_ANOTHER = 29,
  // A fault of the library, to be reported with its text.
  WOVENFIT_STATUS_INTERNAL = 100,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum wovenfit_status wovenfit_status;
#else
typedef int32_t wovenfit_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A text about a format of the pattern.
enum wovenfit_format_text
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Its short name: "pdf-a4".
  WOVENFIT_FORMAT_TEXT_NAME = 1,
  // What its file is called: "pattern-a4.pdf".
  WOVENFIT_FORMAT_TEXT_FILE_NAME = 2,
  // What it is for, in one line.
  WOVENFIT_FORMAT_TEXT_SUMMARY = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum wovenfit_format_text wovenfit_format_text;
#else
typedef int32_t wovenfit_format_text;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A stage of a job, in the order in which they come. Stages that are not needed are left out.
enum wovenfit_job_stage
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // It has not begun.
  WOVENFIT_JOB_STAGE_WAITING = 0,
  // Checking and repairing the surface.
  WOVENFIT_JOB_STAGE_SURFACE = 1,
  // Keeping the region that the brace covers.
  WOVENFIT_JOB_STAGE_REGION = 2,
  // Cutting the region open into a disk.
  WOVENFIT_JOB_STAGE_CUT = 3,
  // The initial planar parameterization.
  WOVENFIT_JOB_STAGE_PARAMETERIZATION = 4,
  // Curvature at the wanted pressures.
  WOVENFIT_JOB_STAGE_CURVATURE = 5,
  // Moving the fabric to its place.
  WOVENFIT_JOB_STAGE_FIT = 6,
  // Interpolating the surface-plane mapping (the method "diffusion" alone).
  WOVENFIT_JOB_STAGE_MAPPING = 7,
  // Outline, seams, and the judgement of what was reached.
  WOVENFIT_JOB_STAGE_REPORT = 8,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum wovenfit_job_stage wovenfit_job_stage;
#else
typedef int32_t wovenfit_job_stage;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Where a job is.
enum wovenfit_job_state
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // It runs.
  WOVENFIT_JOB_STATE_RUNNING = 0,
  // It has a result.
  WOVENFIT_JOB_STATE_DONE = 1,
  // It ended without; wovenfit_job_result says why.
  WOVENFIT_JOB_STATE_FAILED = 2,
  // It was cancelled.
  WOVENFIT_JOB_STATE_CANCELLED = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum wovenfit_job_state wovenfit_job_state;
#else
typedef int32_t wovenfit_job_state;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A text about a defect or a warning.
enum wovenfit_note_text
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // A frozen short name that programs can test, such as "non_manifold_edge".
  WOVENFIT_NOTE_TEXT_CODE = 1,
  // What it is, where, and what to do, for people.
  WOVENFIT_NOTE_TEXT_MESSAGE = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum wovenfit_note_text wovenfit_note_text;
#else
typedef int32_t wovenfit_note_text;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What a parameter may be.
enum wovenfit_parameter_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // A number in a closed range.
  WOVENFIT_PARAMETER_KIND_NUMBER = 1,
  // A whole number in a closed range.
  WOVENFIT_PARAMETER_KIND_INTEGER = 2,
  // "true" or "false".
  WOVENFIT_PARAMETER_KIND_SWITCH = 3,
  // One of some names.
  WOVENFIT_PARAMETER_KIND_CHOICE = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum wovenfit_parameter_kind wovenfit_parameter_kind;
#else
typedef int32_t wovenfit_parameter_kind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A text about a parameter.
enum wovenfit_parameter_text
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Its name in snake case.
  WOVENFIT_PARAMETER_TEXT_NAME = 1,
  // Its unit, empty where it has none.
  WOVENFIT_PARAMETER_TEXT_UNIT = 2,
  // Its default, as text.
  WOVENFIT_PARAMETER_TEXT_DEFAULT = 3,
  // What it does, in one line.
  WOVENFIT_PARAMETER_TEXT_SUMMARY = 4,
  // When and why to change it, in a paragraph.
  WOVENFIT_PARAMETER_TEXT_PARAGRAPH = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum wovenfit_parameter_text wovenfit_parameter_text;
#else
typedef int32_t wovenfit_parameter_text;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// An array of 64-bit numbers of a result. V and T are the numbers of vertices and triangles of the
// cut surface, GV and GT those of the mesh given.
enum wovenfit_result_array
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // V x 2: pattern coordinates of the cut surface's vertices in mm, x along warp, y along weft, the
  // pattern's lower left corner at the origin.
  WOVENFIT_RESULT_ARRAY_PATTERN = 1,
  // T x 3 x 2: the same for every corner of every triangle.
  WOVENFIT_RESULT_ARRAY_PATTERN_PER_CORNER = 2,
  // V x 3: places of the cut surface's vertices in mm.
  WOVENFIT_RESULT_ARRAY_POSITIONS = 3,
  // V x 3: weights of the corners of the given triangle in which each vertex lies
  // (WOVENFIT_RESULT_INDEX_ARRAY_VERTEX_TO_GIVEN_TRIANGLE); they sum to 1. Zeros without one.
  WOVENFIT_RESULT_ARRAY_VERTEX_WEIGHTS = 4,
  // V: strain along warp.
  WOVENFIT_RESULT_ARRAY_WARP_STRAIN = 5,
  // V: strain along weft.
  WOVENFIT_RESULT_ARRAY_WEFT_STRAIN = 6,
  // V: present area over rest area.
  WOVENFIT_RESULT_ARRAY_AREA_STRETCH = 7,
  // V: pressure in kPa, negative where the fabric would lift off.
  WOVENFIT_RESULT_ARRAY_PRESSURE_KPA = 8,
  // V: coefficient of friction needed to hold the fabric; NaN near a free edge and where nearly
  // nothing presses.
  WOVENFIT_RESULT_ARRAY_FRICTION = 9,
  // n x 2: pattern coordinates along all outline loops, one after the other, in mm. The first loop
  // is the outer one.
  WOVENFIT_RESULT_ARRAY_OUTLINE = 10,
  // n x 2: lengths in the pattern of the left and right side of each seam, in mm.
  WOVENFIT_RESULT_ARRAY_SEAM_LENGTHS = 11,
  // n x 2: distance along the limb from the end near the body and girth there, in mm.
  WOVENFIT_RESULT_ARRAY_GIRTHS = 12,
  // n x 2: pattern coordinates of the wanted pressures in the order of the table, in mm.
  WOVENFIT_RESULT_ARRAY_PRESSURE_POINTS = 13,
  // 2 x 2: pattern coordinates of the orientation markers in mm, the first near the body.
  WOVENFIT_RESULT_ARRAY_ORIENTATION_MARKERS = 14,
  // GT x 3 x 2: pattern coordinates for every corner of the given triangles, in their order, in mm;
  // NaN where the brace does not cover a triangle's middle. A triangle through which the edge or a
  // seam runs belongs to the side of its middle, and goes on linearly beyond.
  WOVENFIT_RESULT_ARRAY_GIVEN_PATTERN_PER_CORNER = 20,
  // GV: strain along warp at the given vertices; NaN where the brace does not cover them.
  WOVENFIT_RESULT_ARRAY_GIVEN_WARP_STRAIN = 21,
  // GV: strain along weft.
  WOVENFIT_RESULT_ARRAY_GIVEN_WEFT_STRAIN = 22,
  // GV: pressure in kPa.
  WOVENFIT_RESULT_ARRAY_GIVEN_PRESSURE_KPA = 23,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum wovenfit_result_array wovenfit_result_array;
#else
typedef int32_t wovenfit_result_array;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// An array of indices of a result; V, T, GV and GT as in wovenfit_result_array. Vertices of the cut
// surface are counted from 0.
enum wovenfit_result_index_array
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // T x 3: corners of the cut surface's triangles, counter-clockwise seen from outside.
  WOVENFIT_RESULT_INDEX_ARRAY_TRIANGLES = 1,
  // V: the given vertex that each vertex is, the first of those that were welded; WOVENFIT_NONE if
  // the cut made it.
  WOVENFIT_RESULT_INDEX_ARRAY_VERTEX_TO_GIVEN_VERTEX = 2,
  // V: a given triangle in which each vertex lies; WOVENFIT_NONE on what closes a hole.
  WOVENFIT_RESULT_INDEX_ARRAY_VERTEX_TO_GIVEN_TRIANGLE = 3,
  // T: the given triangle in which the middle of each triangle lies; WOVENFIT_NONE on what closes a
  // hole.
  WOVENFIT_RESULT_INDEX_ARRAY_TRIANGLE_TO_GIVEN_TRIANGLE = 4,
  // The vertices along all outline loops, one after the other; as many as the outline has points.
  WOVENFIT_RESULT_INDEX_ARRAY_OUTLINE = 5,
  // n + 1: where each outline loop starts in the outline, and the end.
  WOVENFIT_RESULT_INDEX_ARRAY_OUTLINE_STARTS = 6,
  // The vertices along the left sides of all seams, one seam after the other. Each side has as many
  // as the other, start sewn to start.
  WOVENFIT_RESULT_INDEX_ARRAY_SEAM_LEFT = 7,
  // The same for the right sides.
  WOVENFIT_RESULT_INDEX_ARRAY_SEAM_RIGHT = 8,
  // n + 1: where each seam starts in the two, and the end.
  WOVENFIT_RESULT_INDEX_ARRAY_SEAM_STARTS = 9,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum wovenfit_result_index_array wovenfit_result_index_array;
#else
typedef int32_t wovenfit_result_index_array;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A text of a result. All but the table are the files that `wovenfit flatten` writes.
enum wovenfit_result_file
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // report.json: every figure.
  WOVENFIT_RESULT_FILE_REPORT_JSON = 1,
  // report.html: the page to read first. Drawn when it is asked for, in about a second.
  WOVENFIT_RESULT_FILE_REPORT_HTML = 2,
  // pattern.svg: the pattern at true size in mm.
  WOVENFIT_RESULT_FILE_PATTERN_SVG = 3,
  // worn.obj: the cut surface in mm with the pattern as texture coordinates.
  WOVENFIT_RESULT_FILE_WORN_OBJ = 4,
  // flat.obj: the pattern as a flat mesh in mm.
  WOVENFIT_RESULT_FILE_FLAT_OBJ = 5,
  // The table of pressures for a terminal.
  WOVENFIT_RESULT_FILE_TABLE = 6,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum wovenfit_result_file wovenfit_result_file;
#else
typedef int32_t wovenfit_result_file;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What a check found. It never changes: any number of threads may use it at once.
typedef struct wovenfit_check wovenfit_check;

// What is wanted of one brace: fabric, pressures, orientation, seams, region. Everything in it is
// checked when it is set. One thread at a time may change it; while nobody does, any may read.
typedef struct wovenfit_design wovenfit_design;

// Why a call failed: a status and a text that says what, where and what to do.
typedef struct wovenfit_error wovenfit_error;

// A flattened brace. It never changes: any number of threads may use it at once.
typedef struct wovenfit_result wovenfit_result;

// A computation under way or ended. All its functions but wovenfit_job_free may be called from any
// thread at any time.
typedef struct wovenfit_job wovenfit_job;

// A mesh of triangles, as it was given, with its unit. It never changes: any number of threads may
// use it at once.
typedef struct wovenfit_mesh wovenfit_mesh;

// A value for every parameter of the table. One thread at a time may change it; while nobody does,
// any may read.
typedef struct wovenfit_parameters wovenfit_parameters;

// A limb that is cut open: what does not change with pressures, fabric and orientation. It never
// changes: any number of threads may use it at once.
typedef struct wovenfit_prepared wovenfit_prepared;

// How far a job is.
typedef struct wovenfit_job_progress {
  // A wovenfit_job_state.
  int32_t state;
  // A wovenfit_job_stage.
  int32_t stage;
  // How much of the stage is done, from 0 to 1.
  double fraction;
  // The fit's energy in N mm; NaN before the fit.
  double energy;
} wovenfit_job_progress;

// What a parameter may be.
typedef struct wovenfit_parameter_bounds {
  // A wovenfit_parameter_kind.
  int32_t kind;
  // How many names it may be; 0 unless it is a choice.
  uint32_t choices;
  // The least number; NaN where there is none.
  double least;
  // The largest number; NaN where there is none.
  double most;
} wovenfit_parameter_bounds;

// The figures of a result.
typedef struct wovenfit_result_summary {
  // Extent of the pattern along warp, in mm.
  double width_mm;
  // Extent of the pattern along weft, in mm.
  double height_mm;
  // Area of the pattern, in mm2.
  double area_mm2;
  // Energy of the fit, in N mm.
  double energy;
  // Radius over which curvature was read, in mm: the scale at which pressure is stated.
  double curvature_radius_mm;
  // Steps of the fit.
  uint64_t steps;
  // 1 if the fit has converged, else 0.
  uint32_t converged;
  // Triangles of the pattern that lie upside down.
  uint32_t flipped;
  // Places where the pattern's edge crosses itself.
  uint32_t overlaps;
  // Wanted pressures.
  uint32_t pressures;
  // Warnings.
  uint32_t warnings;
  // 0.
  uint32_t reserved;
} wovenfit_result_summary;

// A row of the table of pressures. NaN stands for what is not known.
typedef struct wovenfit_pressure {
  // Where it is wanted, in mm.
  double at[3];
  // Wanted, in kPa.
  double asked_kpa;
  // Computed with the tension equal along the thread, in kPa.
  double got_kpa;
  // Computed from the fabric's strain near the point alone, in kPa.
  double got_local_kpa;
  // Mean curvature per metre, outward positive.
  double mean_curvature_per_m;
  // Curvature along warp per metre.
  double warp_curvature_per_m;
  // Curvature along weft per metre.
  double weft_curvature_per_m;
  // Strain along warp.
  double warp_strain;
  // Strain along weft.
  double weft_strain;
  // Least pressure that strains from zero to the fabric's limit give here, in kPa.
  double reachable_least_kpa;
  // Largest such pressure, in kPa.
  double reachable_most_kpa;
  // 1 if it is met; 0 if it is missed, and then there is a reason.
  uint32_t met;
  // 0.
  uint32_t reserved;
} wovenfit_pressure;

// Every status.
#define wovenfit_status_ALL { wovenfit_status_Ok, wovenfit_status_NullArgument, wovenfit_status_InvalidArgument, wovenfit_status_BufferTooSmall, wovenfit_status_TooLarge, wovenfit_status_NotUtf8, wovenfit_status_AbiMismatch, wovenfit_status_NotReady, wovenfit_status_Timeout, wovenfit_status_Cancelled, wovenfit_status_OutOfRange, wovenfit_status_Design, wovenfit_status_Parameter, wovenfit_status_Surface, wovenfit_status_Unit, wovenfit_status_Seam, wovenfit_status_Pressure, wovenfit_status_Parameterization, wovenfit_status_Fit, wovenfit_status_Mapping, wovenfit_status_PreparedForAnother, wovenfit_status_Internal, }

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Checks a mesh as a job would take it. A mesh with defects is no failure: they are in the check.
//
// `design` may be NULL; of it the facing bears on the check. `parameters` may be NULL for the
// defaults. Takes about a second for 250,000 triangles.
//
// Any thread. Free `check` with wovenfit_check_free.
wovenfit_status wovenfit_check_run(const struct wovenfit_mesh *mesh,
                                   const struct wovenfit_design *design,
                                   const struct wovenfit_parameters *parameters,
                                   struct wovenfit_check **check,
                                   struct wovenfit_error **error);

// The check as the JSON that `wovenfit check --json` prints: unit, size, girths, openings, curvature,
// warnings, defects.
//
// Any thread.
wovenfit_status wovenfit_check_json(const struct wovenfit_check *check,
                                    char *buffer,
                                    size_t capacity,
                                    size_t *needed,
                                    struct wovenfit_error **error);

// Numbers of defects and of warnings. A mesh without defects can be flattened.
//
// Any thread.
wovenfit_status wovenfit_check_count(const struct wovenfit_check *check,
                                     size_t *defects,
                                     size_t *warnings,
                                     struct wovenfit_error **error);

// A text about defect `index`, counted from 0; `what` is a wovenfit_note_text.
//
// Any thread.
wovenfit_status wovenfit_check_defect_text(const struct wovenfit_check *check,
                                           size_t index,
                                           int32_t what,
                                           char *buffer,
                                           size_t capacity,
                                           size_t *needed,
                                           struct wovenfit_error **error);

// The place of defect `index`: x, y, z in mm, NaN if it is at no one place.
//
// Any thread.
wovenfit_status wovenfit_check_defect_place(const struct wovenfit_check *check,
                                            size_t index,
                                            double *at,
                                            struct wovenfit_error **error);

// The vertices of the mesh given that defect `index` is about; may be none.
//
// Any thread.
wovenfit_status wovenfit_check_defect_vertices(const struct wovenfit_check *check,
                                               size_t index,
                                               uint32_t *buffer,
                                               size_t capacity,
                                               size_t *count,
                                               struct wovenfit_error **error);

// The triangles of the mesh given that defect `index` is about; may be none.
//
// Any thread.
wovenfit_status wovenfit_check_defect_triangles(const struct wovenfit_check *check,
                                                size_t index,
                                                uint32_t *buffer,
                                                size_t capacity,
                                                size_t *count,
                                                struct wovenfit_error **error);

// A text about warning `index`, counted from 0; `what` is a wovenfit_note_text.
//
// Any thread.
wovenfit_status wovenfit_check_warning_text(const struct wovenfit_check *check,
                                            size_t index,
                                            int32_t what,
                                            char *buffer,
                                            size_t capacity,
                                            size_t *needed,
                                            struct wovenfit_error **error);

// The place of warning `index`: x, y, z in mm, NaN if it is at no one place.
//
// Any thread.
wovenfit_status wovenfit_check_warning_place(const struct wovenfit_check *check,
                                             size_t index,
                                             double *at,
                                             struct wovenfit_error **error);

// Frees a check; NULL is fine.
//
// No other thread may be using the handle.
void wovenfit_check_free(struct wovenfit_check *check);

// Makes an empty design: the default fabric, no pressures, the whole surface. `mm_per_unit`:
// millimetres in one unit of all coordinates that are given to it, as for a mesh.
//
// Any thread. Free `design` with wovenfit_design_free.
wovenfit_status wovenfit_design_new(double mm_per_unit,
                                    struct wovenfit_design **design,
                                    struct wovenfit_error **error);

// Makes a design from the JSON text of a design file; refusals are the command line's own
// (WOVENFIT_STATUS_DESIGN). Its coordinates are in its `units`; where it says none they are in
// `mm_per_unit`, which must then be one of 1, 10, 1000 and 25.4. Coordinates given later are in
// `mm_per_unit`.
//
// Any thread. Free `design` with wovenfit_design_free.
wovenfit_status wovenfit_design_from_json(const char *json,
                                          double mm_per_unit,
                                          struct wovenfit_design **design,
                                          struct wovenfit_error **error);

// Makes a copy of a design.
//
// Any thread, while nobody changes `design`. Free `copy` with wovenfit_design_free.
wovenfit_status wovenfit_design_copy(const struct wovenfit_design *design,
                                     struct wovenfit_design **copy,
                                     struct wovenfit_error **error);

// The design as the JSON text of a design file in mm and kPa; read again it gives the same design.
//
// Any thread, while nobody changes `design`.
wovenfit_status wovenfit_design_json(const struct wovenfit_design *design,
                                     char *buffer,
                                     size_t capacity,
                                     size_t *needed,
                                     struct wovenfit_error **error);

// The JSON schema (draft 2020-12) of the design file, with descriptions.
//
// Any thread.
wovenfit_status wovenfit_design_schema(char *buffer,
                                       size_t capacity,
                                       size_t *needed,
                                       struct wovenfit_error **error);

// Sets a number by its name in the design file: "fabric.warp", "fabric.weft", "fabric.diagonal" (all
// N/mm), "fabric.s", "fabric.max_strain", "fabric.weft_strain" (strains, no unit),
// "limits.max_kpa" (kPa), "piece.quantity", "piece.seam_allowance_mm", "piece.top_allowance_mm",
// "piece.bottom_allowance_mm", "piece.edge_allowance_mm", "piece.notch_spacing_mm" (mm).
// Ranges are the design file's (WOVENFIT_STATUS_DESIGN).
//
// One thread at a time.
wovenfit_status wovenfit_design_set_number(struct wovenfit_design *design,
                                           const char *name,
                                           double value,
                                           struct wovenfit_error **error);

// Sets a text by its name in the design file: "fabric.name", "pressure_model" ("laplace" or
// "paper"), "facing" ("outward" or "inward"), "piece.name", "piece.reference", "piece.date",
// "piece.material".
//
// One thread at a time.
wovenfit_status wovenfit_design_set_text(struct wovenfit_design *design,
                                         const char *name,
                                         const char *value,
                                         struct wovenfit_error **error);

// Takes a wish out so that its default holds: any name above, or "pressures", "orientation",
// "seams", "region" (its planes), "region_faces" (its triangles), "limits.bony", "fabric", "limits",
// "piece".
//
// One thread at a time.
wovenfit_status wovenfit_design_clear(struct wovenfit_design *design,
                                      const char *name,
                                      struct wovenfit_error **error);

// Number of wanted pressures.
//
// Any thread, while nobody changes `design`.
wovenfit_status wovenfit_design_pressure_count(const struct wovenfit_design *design,
                                               size_t *count,
                                               struct wovenfit_error **error);

// Frees a design; NULL is fine. Jobs started with it stay.
//
// No other thread may be using the handle.
void wovenfit_design_free(struct wovenfit_design *design);

// The status of an error; WOVENFIT_STATUS_OK for NULL.
//
// Any thread.
wovenfit_status wovenfit_error_status(const struct wovenfit_error *error);

// The text of an error: what, where (places in mm, elements counted from 0) and what to do.
// `needed` becomes its size in bytes with the NUL.
//
// Any thread.
wovenfit_status wovenfit_error_text(const struct wovenfit_error *error,
                                    char *buffer,
                                    size_t capacity,
                                    size_t *needed);

// Frees an error object; NULL is fine.
//
// The object must not be in use by another thread.
void wovenfit_error_free(struct wovenfit_error *error);

// Number of formats of the pattern. They are counted from 0 in the order in which menus show them.
//
// Any thread.
size_t wovenfit_format_count(void);

// A text about a format of the pattern; `what` is a wovenfit_format_text.
//
// Any thread.
wovenfit_status wovenfit_format_describe(size_t index,
                                         int32_t what,
                                         char *buffer,
                                         size_t capacity,
                                         size_t *needed,
                                         struct wovenfit_error **error);

// The pattern of a result as a file's bytes, with the pieces of its design: allowances, notches, what
// is written on them. `format` is a format's short name; `unit`, "mm" or "in", is that of the numbers
// in SVG and DXF and of the words in all. The first call for one makes it.
//
// Any thread.
wovenfit_status wovenfit_result_pattern(const struct wovenfit_result *result,
                                        const char *format,
                                        const char *unit,
                                        uint8_t *buffer,
                                        size_t capacity,
                                        size_t *count,
                                        struct wovenfit_error **error);

// What a format of the pattern cannot hold and says instead, a line each: letters of a name, a name
// that is too long. Empty where it holds all. Arguments as for wovenfit_result_pattern.
//
// Any thread.
wovenfit_status wovenfit_result_pattern_notes(const struct wovenfit_result *result,
                                              const char *format,
                                              const char *unit,
                                              char *buffer,
                                              size_t capacity,
                                              size_t *needed,
                                              struct wovenfit_error **error);

// Starts the way from a mesh and a design to a pattern, on a thread of its own.
//
// `parameters` may be NULL for the defaults. What cannot be seen at once ends the job later: poll
// or wait, then ask wovenfit_job_result. The objects given may be changed and freed meanwhile.
//
// Any thread, while nobody changes `design` and `parameters`. Free `job` with wovenfit_job_free.
wovenfit_status wovenfit_job_start(const struct wovenfit_mesh *mesh,
                                   const struct wovenfit_design *design,
                                   const struct wovenfit_parameters *parameters,
                                   struct wovenfit_job **job,
                                   struct wovenfit_error **error);

// Starts a job on a limb that was prepared by an earlier one, after a changed pressure, fabric or
// orientation: a part of the time.
//
// `earlier` may be NULL, or a result on this prepared limb: the fit then starts from it. A design or
// parameters that need another preparation (region, seams, facing, unit, or a parameter of the
// stages before the fit) end the job with WOVENFIT_STATUS_PREPARED_FOR_ANOTHER. `parameters` may be
// NULL for the defaults.
//
// Any thread, while nobody changes `design` and `parameters`. Free `job` with wovenfit_job_free.
wovenfit_status wovenfit_job_start_prepared(const struct wovenfit_prepared *prepared,
                                            const struct wovenfit_result *earlier,
                                            const struct wovenfit_design *design,
                                            const struct wovenfit_parameters *parameters,
                                            struct wovenfit_job **job,
                                            struct wovenfit_error **error);

// How far a job is. Never waits for the work.
//
// Any thread.
wovenfit_status wovenfit_job_poll(const struct wovenfit_job *job,
                                  struct wovenfit_job_progress *progress,
                                  struct wovenfit_error **error);

// Asks a job to stop; it ends soon after with WOVENFIT_STATUS_CANCELLED, unless it had ended already.
// Does not wait.
//
// Any thread.
wovenfit_status wovenfit_job_cancel(const struct wovenfit_job *job,
                                    struct wovenfit_error **error);

// Waits until a job has ended, however it did: WOVENFIT_STATUS_OK, or WOVENFIT_STATUS_TIMEOUT if it
// still runs after `seconds`. Negative seconds wait without end.
//
// Any thread.
wovenfit_status wovenfit_job_wait(const struct wovenfit_job *job,
                                  double seconds,
                                  struct wovenfit_error **error);

// The result of a job, or why it has none: WOVENFIT_STATUS_NOT_READY while it runs, else its own
// status and text. May be asked again; each object is freed on its own.
//
// Any thread. Free `result` with wovenfit_result_free.
wovenfit_status wovenfit_job_result(const struct wovenfit_job *job,
                                    struct wovenfit_result **result,
                                    struct wovenfit_error **error);

// The prepared limb of a job, to solve again on; WOVENFIT_STATUS_NOT_READY before it is there, also if
// the job ended before. There even where the fit failed.
//
// Any thread. Free `prepared` with wovenfit_prepared_free.
wovenfit_status wovenfit_job_prepared(const struct wovenfit_job *job,
                                      struct wovenfit_prepared **prepared,
                                      struct wovenfit_error **error);

// Frees a job; NULL is fine. One that runs is cancelled, and the call waits until it has stopped.
// Results and prepared limbs taken from it stay.
//
// No other thread may be using the handle.
void wovenfit_job_free(struct wovenfit_job *job);

// A stage's short name, such as "surface"; "unknown" for other numbers. It is never freed.
//
// Any thread.
const char *wovenfit_stage_name(int32_t stage);

// Makes a mesh of 64-bit coordinates.
//
// `positions`: x, y, z of each of `vertex_count` vertices, the next vertex `stride` bytes further
// (0 for 24). `triangles`: three vertices, counted from 0, for each of `triangle_count`,
// counter-clockwise seen from outside the limb; polygons are the caller's to split. `mm_per_unit`:
// millimetres in one unit of the coordinates. The buffers are copied. Whether the mesh is sound is
// for wovenfit_check_run and the job to say, so that every defect is named; here only NULL, counts,
// stride and unit are refused.
//
// Any thread. Free `mesh` with wovenfit_mesh_free.
wovenfit_status wovenfit_mesh_new_f64(const double *positions,
                                      size_t vertex_count,
                                      size_t stride,
                                      const uint32_t *triangles,
                                      size_t triangle_count,
                                      double mm_per_unit,
                                      struct wovenfit_mesh **mesh,
                                      struct wovenfit_error **error);

// Makes a mesh of 32-bit coordinates; all else is as in wovenfit_mesh_new_f64, a `stride` of 0
// means 12.
//
// Any thread. Free `mesh` with wovenfit_mesh_free.
wovenfit_status wovenfit_mesh_new_f32(const float *positions,
                                      size_t vertex_count,
                                      size_t stride,
                                      const uint32_t *triangles,
                                      size_t triangle_count,
                                      double mm_per_unit,
                                      struct wovenfit_mesh **mesh,
                                      struct wovenfit_error **error);

// The millimetres in a unit by its name: "mm", "cm", "m" or "in".
//
// Any thread.
wovenfit_status wovenfit_unit_millimetres(const char *name,
                                          double *mm_per_unit,
                                          struct wovenfit_error **error);

// Numbers of vertices and triangles of a mesh, as given.
//
// Any thread.
wovenfit_status wovenfit_mesh_size(const struct wovenfit_mesh *mesh,
                                   size_t *vertex_count,
                                   size_t *triangle_count,
                                   struct wovenfit_error **error);

// Frees a mesh; NULL is fine. Designs, jobs and results made from it stay.
//
// No other thread may be using the handle.
void wovenfit_mesh_free(struct wovenfit_mesh *mesh);

// Number of parameters in the table. They are counted from 0 in the order in which dialogs show
// them.
//
// Any thread.
size_t wovenfit_parameter_count(void);

// A text about a parameter; `what` is a wovenfit_parameter_text.
//
// Any thread.
wovenfit_status wovenfit_parameter_describe(size_t index,
                                            int32_t what,
                                            char *buffer,
                                            size_t capacity,
                                            size_t *needed,
                                            struct wovenfit_error **error);

// What a parameter may be.
//
// Any thread.
wovenfit_status wovenfit_parameter_range(size_t index,
                                         struct wovenfit_parameter_bounds *range,
                                         struct wovenfit_error **error);

// A name that a parameter may be; `choice` counts from 0.
//
// Any thread.
wovenfit_status wovenfit_parameter_choice(size_t index,
                                          size_t choice,
                                          char *buffer,
                                          size_t capacity,
                                          size_t *needed,
                                          struct wovenfit_error **error);

// Makes parameters with the table's defaults.
//
// Any thread. Free `parameters` with wovenfit_parameters_free.
wovenfit_status wovenfit_parameters_new(struct wovenfit_parameters **parameters,
                                        struct wovenfit_error **error);

// Makes a copy of parameters.
//
// Any thread, while nobody changes `parameters`. Free `copy` with wovenfit_parameters_free.
wovenfit_status wovenfit_parameters_copy(const struct wovenfit_parameters *parameters,
                                         struct wovenfit_parameters **copy,
                                         struct wovenfit_error **error);

// Sets a parameter by its name from text: "5.5", "true", "newton". WOVENFIT_STATUS_PARAMETER says
// the nearest name, or the range.
//
// One thread at a time.
wovenfit_status wovenfit_parameters_set(struct wovenfit_parameters *parameters,
                                        const char *name,
                                        const char *value,
                                        struct wovenfit_error **error);

// The value of a parameter as text.
//
// Any thread, while nobody changes `parameters`.
wovenfit_status wovenfit_parameters_get(const struct wovenfit_parameters *parameters,
                                        const char *name,
                                        char *buffer,
                                        size_t capacity,
                                        size_t *needed,
                                        struct wovenfit_error **error);

// Frees parameters; NULL is fine. Jobs started with them stay.
//
// No other thread may be using the handle.
void wovenfit_parameters_free(struct wovenfit_parameters *parameters);

// Frees a prepared limb; NULL is fine. Jobs and results made from it stay.
//
// No other thread may be using the handle.
void wovenfit_prepared_free(struct wovenfit_prepared *prepared);

// The figures of a result.
//
// Any thread.
wovenfit_status wovenfit_result_figures(const struct wovenfit_result *result,
                                        struct wovenfit_result_summary *figures,
                                        struct wovenfit_error **error);

// A row of the table of pressures; `index` counts from 0 in the order of the design.
//
// Any thread.
wovenfit_status wovenfit_result_pressure(const struct wovenfit_result *result,
                                         size_t index,
                                         struct wovenfit_pressure *pressure,
                                         struct wovenfit_error **error);

// Why pressure `index` is missed; empty where it is met. `what` is a wovenfit_note_text.
//
// Any thread.
wovenfit_status wovenfit_result_pressure_reason(const struct wovenfit_result *result,
                                                size_t index,
                                                int32_t what,
                                                char *buffer,
                                                size_t capacity,
                                                size_t *needed,
                                                struct wovenfit_error **error);

// A text about warning `index`, counted from 0; `what` is a wovenfit_note_text.
//
// Any thread.
wovenfit_status wovenfit_result_warning_text(const struct wovenfit_result *result,
                                             size_t index,
                                             int32_t what,
                                             char *buffer,
                                             size_t capacity,
                                             size_t *needed,
                                             struct wovenfit_error **error);

// The place of warning `index`: x, y, z in mm, NaN if it is at no one place.
//
// Any thread.
wovenfit_status wovenfit_result_warning_place(const struct wovenfit_result *result,
                                              size_t index,
                                              double *at,
                                              struct wovenfit_error **error);

// The prepared limb of a result, to solve again on.
//
// Any thread. Free `prepared` with wovenfit_prepared_free.
wovenfit_status wovenfit_result_prepared(const struct wovenfit_result *result,
                                         struct wovenfit_prepared **prepared,
                                         struct wovenfit_error **error);

// Frees a result; NULL is fine.
//
// No other thread may be using the handle.
void wovenfit_result_free(struct wovenfit_result *result);

// An array of numbers of a result; `what` is a wovenfit_result_array, `capacity` and `count` are in
// numbers. The first call for one about the given mesh finds the way back to it, in a fraction of
// the job's time.
//
// Any thread.
wovenfit_status wovenfit_result_doubles(const struct wovenfit_result *result,
                                        int32_t what,
                                        double *buffer,
                                        size_t capacity,
                                        size_t *count,
                                        struct wovenfit_error **error);

// An array of indices of a result; `what` is a wovenfit_result_index_array, all else as in
// wovenfit_result_doubles.
//
// Any thread.
wovenfit_status wovenfit_result_indices(const struct wovenfit_result *result,
                                        int32_t what,
                                        uint32_t *buffer,
                                        size_t capacity,
                                        size_t *count,
                                        struct wovenfit_error **error);

// A text of a result; `what` is a wovenfit_result_file. The first call for one makes it.
//
// Any thread.
wovenfit_status wovenfit_result_text(const struct wovenfit_result *result,
                                     int32_t what,
                                     char *buffer,
                                     size_t capacity,
                                     size_t *needed,
                                     struct wovenfit_error **error);

// A status' short name, such as "buffer_too_small", for logs; "unknown" for other numbers. It is
// never freed.
//
// Any thread.
const char *wovenfit_status_name(int32_t status);

// The ABI number of the library that is loaded.
//
// Any thread.
uint32_t wovenfit_abi_version(void);

// The library's version, such as "0.1.0"; never freed. Results of different versions may differ.
//
// Any thread.
const char *wovenfit_version(void);

// Refuses a caller who was made for another ABI number: call it first, with WOVENFIT_ABI_VERSION.
// WOVENFIT_STATUS_ABI_MISMATCH names both numbers.
//
// Any thread.
wovenfit_status wovenfit_check_abi(uint32_t abi, struct wovenfit_error **error);

// Adds wanted pressures at points.
//
// `positions`: x, y, z of each of `count` points, in the design's unit, on the surface or within
// 10 mm of it. `kpa`: the wanted pressure of each, in kPa, 0 to 13.3 unless "limits.max_kpa" allows
// more.
//
// One thread at a time.
wovenfit_status wovenfit_design_add_pressures(struct wovenfit_design *design,
                                              const double *positions,
                                              const double *kpa,
                                              size_t count,
                                              struct wovenfit_error **error);

// Adds wanted pressures at vertices of a mesh: `vertices`, counted from 0, and `kpa` have `count`
// numbers each; `kpa` is as in wovenfit_design_add_pressures.
//
// One thread at a time.
wovenfit_status wovenfit_design_add_pressures_at_vertices(struct wovenfit_design *design,
                                                          const struct wovenfit_mesh *mesh,
                                                          const uint32_t *vertices,
                                                          const double *kpa,
                                                          size_t count,
                                                          struct wovenfit_error **error);

// Adds the pressures painted onto a mesh: `kpa` is a value for each of its vertices in kPa, 0 where
// nothing is asked; `count` is their number and must be that of the vertices.
//
// Painted vertices are condensed to at most 200 points at least 10 mm apart, each wanting the mean
// of the values round it; a warning of the result says how many became how many, and the table of
// pressures lists the points. Paint that was there before stays: clear "pressures" first.
//
// One thread at a time.
wovenfit_status wovenfit_design_paint_pressures(struct wovenfit_design *design,
                                                const struct wovenfit_mesh *mesh,
                                                const double *kpa,
                                                size_t count,
                                                struct wovenfit_error **error);

// Sets the two orientation markers at points: `positions` is x, y, z of both in the design's unit,
// the first near the body. In the pattern they stand above each other: the weft direction.
//
// One thread at a time.
wovenfit_status wovenfit_design_set_orientation(struct wovenfit_design *design,
                                                const double *positions,
                                                struct wovenfit_error **error);

// Sets the two orientation markers at vertices of a mesh, `first` near the body.
//
// One thread at a time.
wovenfit_status wovenfit_design_set_orientation_at_vertices(struct wovenfit_design *design,
                                                            const struct wovenfit_mesh *mesh,
                                                            uint32_t first,
                                                            uint32_t second,
                                                            struct wovenfit_error **error);

// Adds a seam along which the surface is cut: `positions` is x, y, z of each of its `count` points,
// two or more, in the design's unit, within 10 mm of the surface. It begins at an edge of the brace
// or at an earlier seam.
//
// One thread at a time.
wovenfit_status wovenfit_design_add_seam(struct wovenfit_design *design,
                                         const double *positions,
                                         size_t count,
                                         struct wovenfit_error **error);

// Adds seams along edges of a mesh: `vertices` is two vertices, counted from 0, for each of
// `edge_count` edges, in any order.
//
// Edges are chained from branch to branch or free end, and their zigzag is drawn straight to within
// an edge's mean length: a seam of zigzags cannot be sewn.
//
// One thread at a time.
wovenfit_status wovenfit_design_add_seams_along_edges(struct wovenfit_design *design,
                                                      const struct wovenfit_mesh *mesh,
                                                      const uint32_t *vertices,
                                                      size_t edge_count,
                                                      struct wovenfit_error **error);

// Adds a plane that bounds the brace: it covers what lies on the side to which all normals point.
// `point`: x, y, z of a point of the plane in the design's unit. `normal`: its direction, of any
// length but zero.
//
// One thread at a time.
wovenfit_status wovenfit_design_add_region_plane(struct wovenfit_design *design,
                                                 const double *point,
                                                 const double *normal,
                                                 struct wovenfit_error **error);

// Sets the triangles of a mesh that the brace covers, `count` of them, counted from 0; it then
// covers what lies in them and within all planes. Its edge follows the triangles' edges. Pressure
// is still read off the whole scan. The design then fits jobs on a mesh of as many triangles only.
//
// One thread at a time.
wovenfit_status wovenfit_design_set_region_triangles(struct wovenfit_design *design,
                                                     const struct wovenfit_mesh *mesh,
                                                     const uint32_t *triangles,
                                                     size_t count,
                                                     struct wovenfit_error **error);

// Adds places where bone lies under the skin, at which the report warns of pressure: x, y, z of each
// of `count` points in the design's unit.
//
// One thread at a time.
wovenfit_status wovenfit_design_add_bony(struct wovenfit_design *design,
                                         const double *positions,
                                         size_t count,
                                         struct wovenfit_error **error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* WOVENFIT_H */
