/**
 * @file io.h
 * Saved states and output for ParaView and VTK, in files or through a callback.
 *
 * A state holds time, step and the controller's dt, the sets in order of mpm_stepper_add() with every field
 * (library order included, so that continuing is bitwise identical), the sums over steps, and a description
 * of grid, materials and scheme. Callbacks and walls are not in it: the host sets them as before;
 * of motion callbacks of sets and obstacles it says that they were there, and no step is made (MPM_E_STATE)
 * until each is set, or answered by NULL after loading. Loading needs a stepper that is set up alike: same
 * grid, scheme, number of sets, laws and host fields; the particles are replaced, and the sets may be empty.
 * States of all versions from 0.1.0 on load; in those of 0.1.0 sums over steps are 0.
 *
 * Of one problem in several parts (parallel.h) each part saves a piece, and all pieces together are the
 * state. Calls that measure or save are then collective: every part makes them, each with a buffer, a path or
 * a callback of its own, and all return the same status. mpm_state_load_pieces() loads from pieces.
 *
 * States and VTK files take the place of the file at their path when they are complete. Until then they are
 * written beside it under the name path.tmp0, or path.tmp1 ... where several are being written, and path
 * holds the old contents. Symbolic links are followed: the file that they lead to is replaced, in its own
 * folder. The mode of a file that was there is kept, and owner and group as far as the process may give files
 * away; if the group cannot be kept, it gets no rights that all others do not have. Another hard link keeps
 * the old contents.
 *
 * A process that dies while it writes leaves its temporary file behind. The next write to the same path
 * removes it: the writer of a temporary file holds a lock on it (flock), and a file is removed only if its
 * lock is free. On storage without locks none is removed. On Windows modes and owners are those of new files
 * in the folder.
 *
 * Paths are UTF-8, also on Windows. In a build without files (MPM_NO_FILES) every call with a path gives
 * MPM_E_UNSUPPORTED. Calls that write to a callback (mpm_write_fn) work in every build.
 */
#ifndef MPM_IO_H
#define MPM_IO_H

#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Takes the next bytes of an output, in the order in which a file would have them: for archives, sockets,
 * browsers. All pieces have 65536 bytes, but for the last one, which has fewer or as many; data are lent for
 * the time of the call. It runs on the calling thread. A return other than 0 ends the output with
 * MPM_E_CALLBACK, and mpm_last_error() tells what was returned and after how many bytes;
 * mpm_step_info.callback_status stays that of the last step. Since 0.2.0. */
typedef mpm_status (*mpm_write_fn)(void *user, const void *data, int64_t bytes);

/** Tells how many bytes mpm_state_save() needs now; of several parts, those of this part's piece
 * (collective). */
MPM_API mpm_status mpm_state_size(const mpm_stepper *stepper, int64_t *bytes);

/** Writes the state into the host's buffer of capacity bytes; of several parts, this part's piece
 * (collective). MPM_E_ARG: the capacity is too small. MPM_E_STATE: a view is out for writing, or a staged
 * step is under way. */
MPM_API mpm_status mpm_state_save(const mpm_stepper *stepper, void *buffer, int64_t capacity);

/** Replaces the state by one saved with mpm_state_save(), of so many bytes; the buffer is read during the
 * call. MPM_E_FORMAT: the bytes are no state, or it is damaged, of a later format, or saved from an unlike
 * setup; the error text names the first difference; or they are one piece of several. MPM_E_STATE: a view is
 * out, or a staged step is under way. MPM_E_UNSUPPORTED: the context is one of several parts, which load by
 * mpm_state_load_pieces(). */
MPM_API mpm_status mpm_state_load(mpm_stepper *stepper, const void *buffer, int64_t bytes);

/** Replaces the state by one in pieces (collective). Each part gives count of them, piece[i] of bytes[i]
 * bytes: part 0 the first few, part 1 those after them, and so on, in the order of the parts that saved them;
 * count may be 0, and then piece and bytes may be NULL. How many parts saved the state and how many load it
 * does not matter, one among them: continuing has the bits of not having stopped. What mpm_state_save() of
 * one part wrote, in any version, is the only piece of its state. Pieces are read during the call and need no
 * alignment. On failure, which all parts return, no part's objects have changed.
 *
 * - MPM_E_ARG: pieces are missing, given twice, out of order, or of different states, which their marks tell;
 *   no part gives one; or an argument is wrong.
 * - MPM_E_FORMAT: as in mpm_state_load(); the text names the piece by its number in `piece`.
 * - MPM_E_STATE: a view is out, or a staged step is under way.
 *
 * Since 0.2.0. */
MPM_API mpm_status mpm_state_load_pieces(mpm_stepper *stepper, int32_t count, const void *const *piece,
                                         const int64_t *bytes);

/** Writes the state into a file, as mpm_state_save() does into memory, and waits for the storage: path holds
 * the old state or the new one. Of several parts, each writes its piece under a path of its own (collective);
 * where one of them could not, others may have replaced their files. MPM_E_IO: the file could not be
 * written. */
MPM_API mpm_status mpm_state_save_file(const mpm_stepper *stepper, const char *path);

/** Gives the bytes of mpm_state_save() to a callback. They are made twice, because the first of them hold a
 * checksum of all others; memory for 65536 bytes is enough. Of several parts, each gives its piece
 * (collective). MPM_E_CALLBACK: the callback refused. MPM_E_STATE: as in mpm_state_save(); or what was
 * written through a view for reading changed the state while it went out. Since 0.2.0. */
MPM_API mpm_status mpm_state_save_to(const mpm_stepper *stepper, mpm_write_fn write, void *user);

/** Replaces the state by one from a file. Errors are those of mpm_state_load(), and MPM_E_IO: the file could
 * not be read. */
MPM_API mpm_status mpm_state_load_file(mpm_stepper *stepper, const char *path);

/** Gives a hash of time, step, every field of every set, the pose of every obstacle and every marker of
 * surfaces. It does not depend on library order, on threads or on optional fields that are not in use: states
 * that are equal by id have equal hashes. */
MPM_API mpm_status mpm_state_hash(const mpm_stepper *stepper, uint64_t *hash);

/** Writes a set as VTK poly data (.vtp, appended raw): points in order of ascending id, and count named
 * fields as point data, with full tensors and, in 2-D and 3-D, with three components per vector. With count
 * 0, when fields may be NULL, it writes every field in use but "position", which the points are. path is
 * UTF-8. MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: a field is named twice. MPM_E_IO: the file could
 * not be written. */
MPM_API mpm_status mpm_write_particles(const mpm_particles *particles, const char *path, int32_t count,
                                       const char *const *fields);

/** Gives the bytes of the file that mpm_write_particles() would write to a callback, with memory for one
 * piece. Errors are the same, but for the path, and with MPM_E_CALLBACK, when the callback refused, in the
 * place of MPM_E_IO. Since 0.2.0. */
MPM_API mpm_status mpm_write_particles_to(const mpm_particles *particles, mpm_write_fn write, void *user,
                                          int32_t count, const char *const *fields);

/**
 * Writes nodal fields of the last step, or of a staged step while one is under way, over the box of the
 * active nodes: as VTK image data (.vti, appended raw), or with open knots, whose nodes are not evenly spaced
 * at the faces, as a rectilinear grid (.vtr). Fields are named as in mpm_grid_map(); vectors have three
 * components in 2-D and 3-D. Extents are indices of nodes; where no node is active values are zero. With
 * count 0, when fields may be NULL, it writes every field that the step has kept but "position", which is
 * that of the points, and "owned". Memory follows the active nodes; long runs of zeros take no room on
 * storage that knows holes.
 *
 * - MPM_E_NOT_FOUND: there is no such field, or no set is in body 0.
 * - MPM_E_STATE: nothing has been stepped yet.
 * - MPM_E_UNSUPPORTED: as in mpm_grid_map().
 * - MPM_E_ARG: a field is named twice, the path ends with the other kind's suffix, or the box has more nodes
 *   than a file can hold.
 * - MPM_E_IO: the file could not be written.
 */
MPM_API mpm_status mpm_write_grid(mpm_stepper *stepper, const char *path, int32_t count,
                                  const char *const *fields);

/** Does as mpm_write_grid() for the nodes of one body; that one writes those of body 0. MPM_E_NOT_FOUND: no
 * set of the stepper is in the body. */
MPM_API mpm_status mpm_write_body_grid(mpm_stepper *stepper, int32_t body, const char *path, int32_t count,
                                       const char *const *fields);

/** Gives the bytes of the file that mpm_write_body_grid() would write to a callback. They are those of a .vtr
 * file if the grid has boundary_basis = MPM_BOUNDARY_OPEN_KNOT and an axis that is not periodic, else those
 * of a .vti file; the second line names the kind, RectilinearGrid or ImageData. Zeros between bodies far
 * apart are all given, however many they are. Memory follows the active nodes, and one piece is added. Errors
 * are the same, but for the path, and with MPM_E_CALLBACK, when the callback refused, in the place of
 * MPM_E_IO. Since 0.2.0. */
MPM_API mpm_status mpm_write_grid_to(mpm_stepper *stepper, int32_t body, mpm_write_fn write, void *user,
                                     int32_t count, const char *const *fields);

/** A time series of output files (.pvd); its file is valid on disk after every append. */
typedef struct mpm_series mpm_series;

/** Starts a series in a new file at path, where it replaces an old one. *out is NULL unless MPM_OK is
 * returned. MPM_E_IO: the file could not be written. */
MPM_API mpm_status mpm_series_open(mpm_context *context, const char *path, mpm_series **out);

/** Appends an output file to the series at time t. file is its path as it is to stand in the series: relative
 * to the series' own file. MPM_E_IO: the file could not be written. */
MPM_API mpm_status mpm_series_append(mpm_series *series, double t, const char *file);

/** Ends the series and frees it. Its file stays. NULL is fine. */
MPM_API mpm_status mpm_series_close(mpm_series *series);

#ifdef __cplusplus
}
#endif

#endif
