/**
 * @file parallel.h
 * One problem in several parts: each part is a context (in a process of its own, or a thread) with grid,
 * materials, sets and steppers made alike, and holds the particles of its own blocks of the grid. The host
 * lends each context a transport; the library says what has to go where, and never opens a connection.
 *
 * Calls marked (collective) are made on all parts, in the same order and with the same arguments, save those
 * that are said to be of a part. All parts return the same status; where it is a failure, the text on the
 * parts that are not at fault says which part is, and its sentence. Grids, materials, sets and steppers are
 * made and set up alike on all parts, by calls that do not wait for other parts: if one of these fails, the
 * host ends the problem on all. Calls that only read or write a part's own objects and are not listed below
 * concern that part alone.
 * With a transport and one part every call behaves as without one, but for the linear solvers of implicit
 * steps, which are those of several parts (below).
 *
 * States, statuses and reports have the same bits for any number of parts, as for any number of threads. A
 * solver of the host is the exception: the solutions of linear systems are as it makes them, and everything
 * else follows from them alike.
 *
 * (collective) are: mpm_context_create(), save that memory may fail on one part alone; adding and filling
 * particles, where each part adds its own and numbers without ids follow those of the parts before;
 * mpm_step() and its three parts, mpm_advance(), mpm_stepper_info(), mpm_stepper_heat_info(),
 * mpm_stable_dt(), mpm_stepper_adapt(), mpm_stepper_set_balance(), mpm_particles_total(),
 * mpm_state_hash(), mpm_state_size(), mpm_state_save() in all its forms and mpm_state_load_pieces().
 * Particles go to the part that has their block of the grid when a step sorts them, wherever they were
 * added. An id is given once over all parts: mpm_particles_add() returns MPM_E_ARG where it is not.
 *
 * Callbacks about nodes, friction, distances and the motion of obstacles are asked on every part that needs
 * the answer, and must give the same on all. Obstacles are made and moved alike on all parts.
 *
 * Surfaces are made and filled alike on all parts: each part has all markers, and moves them alike.
 * Callbacks of surfaces are asked on every part for all markers and must answer alike.
 *
 * Sets are described alike on all parts where they adapt. Whether a particle is split or a pair merged, the
 * part is asked that has their cell: not always the one that has the particle.
 *
 * Of several parts these are asked for explicit steps, and for implicit ones whose linear systems the
 * library's iterations solve: MPM_SOLVER_CG, and MPM_SOLVER_GMRES for those that are not symmetric; or a
 * solver of the host, MPM_SOLVER_HOST, as libmpm-petsc has one (operator.h). With a transport
 * MPM_SOLVER_AUTO stands for one of the two iterations, and takes GMRES too where conjugate gradients have
 * failed; and GMRES has no multigrid as preconditioner. That is so for one part, too, so that bits do not
 * depend on the number of parts; one part may ask for MPM_SOLVER_MULTIGRID_CG or MPM_SOLVER_LDLT by name.
 * MPM_E_UNSUPPORTED: these two of several parts.
 */
#ifndef MPM_PARALLEL_H
#define MPM_PARALLEL_H

#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How much of an exchange its receivers know beforehand. */
enum mpm_exchange_value {
  MPM_EXCHANGE_KNOWN = 1, /**< both sides know who sends to whom: partners send and receive */
  MPM_EXCHANGE_SPARSE = 2 /**< receivers do not know from whom: particles that move, changes of the pattern */
};

/** What mpm_reduce_fn does. There is no sum of floating-point numbers: it would depend on the parts. */
enum mpm_reduce_value {
  MPM_REDUCE_MAX = 1, /**< the largest of all parts */
  MPM_REDUCE_SUM = 2  /**< the sum, modulo 2^64 */
};

/** Bytes for, or from, another part. */
typedef struct mpm_message {
  int32_t part;     /**< to whom, or from whom */
  int32_t reserved; /**< 0; not looked at in what arrives */
  int64_t bytes;    /**< how many; 0 is sent too where the partner is known */
  /** out: the library's, unchanged until mpm_receive_fn returns; in: the host's, at a multiple of 64, valid
   * until the next mpm_send_fn. */
  void *data;
} mpm_message;

/** Starts an exchange and returns before it is done. out: ascending by part, never this one. most: of each
 * partner, a bound on what comes from it, [count]; NULL with MPM_EXCHANGE_SPARSE. Returns 0, or < 0: then the
 * context is unusable (MPM_E_CALLBACK), for the other parts are lost. */
typedef mpm_status (*mpm_send_fn)(void *user, int32_t exchange, int32_t count, const mpm_message *out,
                                  const int64_t *most);

/** Ends the exchange: all that was sent to this part, ascending by part. Returns as mpm_send_fn. */
typedef mpm_status (*mpm_receive_fn)(void *user, int32_t *count, const mpm_message **in);

/** values[count] of all parts into each of them (collective). Returns as mpm_send_fn. */
typedef mpm_status (*mpm_reduce_fn)(void *user, int32_t op, int64_t count, int64_t *values);

/** all[parts]: value of each part (collective). Only when particles are added, sets adapt, implicit steps
 * number their unknowns or pieces of a state are loaded. Returns as mpm_send_fn. */
typedef mpm_status (*mpm_gather_fn)(void *user, int64_t value, int64_t *all);

/** Ways between the parts. All are called on the calling thread. Once one has failed, every collective call
 * of the context returns MPM_E_CALLBACK. */
typedef struct mpm_transport {
  uint32_t struct_size;   /**< sizeof(mpm_transport) of the caller */
  int32_t part;           /**< of this context, 0 ... parts - 1 */
  int32_t parts;          /**< how many there are */
  int32_t reserved;       /**< 0 */
  mpm_send_fn send;       /**< required, as the three that follow */
  mpm_receive_fn receive; /**< ends what send started */
  mpm_reduce_fn reduce;   /**< maxima and sums of integers */
  mpm_gather_fn gather;   /**< one integer of each part */
  /** For transports that move only when called: called up to eight times between send and receive of a sum on
   * nodes, after each group of the blocks whose sums are made meanwhile. May be NULL. */
  void (*poll)(void *user);
  void *user; /**< passed to all of them */
} mpm_transport;

/** Number of this part and how many there are; 0 and 1 without a transport. Pointers may be NULL. */
MPM_API mpm_status mpm_context_part(const mpm_context *context, int32_t *part, int32_t *parts);

/** Particles of a set on all parts (collective). mpm_particles_count() is that of this part. */
MPM_API mpm_status mpm_particles_total(const mpm_particles *particles, int64_t *n);

/** How blocks of the grid are given to parts. Fill it with mpm_balance_desc_init(); all 0 are the defaults.
 */
typedef struct mpm_balance_desc {
  uint32_t struct_size; /**< sizeof(mpm_balance_desc) of the caller */
  /** 0 (default): a block weighs what its particles and block_weight come to. 1: the seconds that a part has
   * spent in steps since blocks were last given to parts, those of waiting left out, are what its blocks
   * weigh together, each in proportion to that. */
  int32_t measure;
  /** Blocks are given to parts anew, at a sort, when the largest weight of a part is this many times the
   * mean, at least 1; infinity: never. 0 (default): 1.1, and only when the steps since the last time would
   * have gained more by it than it costs to move the particles. */
  double limit;
  /** What a block costs beside its particles, in particles, from 0 to 1e6. 0 (default): 60, about what the
   * sums of its nodes take. */
  double block_weight;
} mpm_balance_desc;

/** Fills desc with the defaults. struct_size is sizeof(mpm_balance_desc) of the caller; no byte beyond is
 * written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time. */
MPM_API mpm_status mpm_balance_desc_init(mpm_balance_desc *desc, uint32_t struct_size);

/** Sets how blocks are given to parts, from the next sort of particles on (collective); desc NULL: by the
 * defaults. Results do not depend on it, bit by bit. Not part of a saved state: the host sets it again. With
 * one part it is checked and does nothing. MPM_E_ARG: a value is out of range, or another one is given on
 * another part. MPM_E_STATE: a step is under way. Since 0.2.0. */
MPM_API mpm_status mpm_stepper_set_balance(mpm_stepper *stepper, const mpm_balance_desc *desc);

/** What one part does of a problem, and what that costs. Counts are of this part, since the stepper was made
 * or they were last reset; the caller sets struct_size. */
typedef struct mpm_parallel_info {
  uint32_t struct_size; /**< sizeof(mpm_parallel_info) of the caller */
  int32_t neighbours;   /**< parts that share nodes with this one */
  int64_t blocks;       /**< with particles of this part */
  int64_t boundary;     /**< of them beside blocks of other parts */
  int64_t ghosts;       /**< blocks of other parts beside them */
  int64_t bytes_nodes;  /**< sent for sums on nodes */
  int64_t bytes_moved;  /**< sent for particles that moved to another part */
  int64_t moved;        /**< such particles */
  int64_t cuts;         /**< how often blocks were given to parts anew */
  double imbalance;     /**< largest weight of a part over the mean at the last sort, the same on all parts */
  double seconds_packing;  /**< packing what is sent, and unpacking particles */
  double seconds_waiting;  /**< in receive */
  double seconds_reducing; /**< in reduce and gather */
} mpm_parallel_info;

/** Tells what this part does, as of the last step; 1 in reset starts the counts anew. MPM_E_ARG: info is NULL
 * or its struct_size is bad. With one part nothing is exchanged: all but blocks and imbalance, 1, is 0. */
MPM_API mpm_status mpm_stepper_parallel_info(mpm_stepper *stepper, int32_t reset, mpm_parallel_info *info);

/** Tells how many bytes mpm_particles_pack() needs for n particles of the set, with the fields that it has
 * now. MPM_E_ARG: n is negative or beyond 2^32 - 2, or bytes is NULL. Since 0.2.0. */
MPM_API mpm_status mpm_particles_packed_size(const mpm_particles *particles, int64_t n, int64_t *bytes);

/**
 * Packs n particles into a buffer, for hosts that move them themselves: between sets, programs, machines.
 * They have every field in use, bit by bit, with ids, images and the host's fields, and what says of which
 * law they are. The order of bytes is the same on all machines. The particles stay in the set.
 *
 * - ids: [n], each once, in this order; NULL for all particles by ascending id, where n is
 *   mpm_particles_count().
 * - buffer: of `capacity` bytes, of which those of mpm_particles_packed_size() are written; anywhere.
 *
 * Of a problem in several parts these are particles of this part, and no other part takes part.
 * MPM_E_NOT_FOUND: an id is not in the set. MPM_E_ARG: capacity is too small, an id is given twice, n does
 * not match or buffer is NULL. MPM_E_STATE: a staged step is under way, a view of the set is out for
 * writing, or a value that was written through one is bad. Since 0.2.0.
 */
MPM_API mpm_status mpm_particles_pack(const mpm_particles *particles, int64_t n, const int64_t *ids,
                                      void *buffer, int64_t capacity);

/**
 * Adds packed particles to a set, bit by bit: all or none. The law is not asked: stress, state variables and
 * volume come along. Fields that the set has and the buffer lacks have the values of new particles. Grids may
 * have other cells and bases, if the particles lie inside.
 *
 * Of a problem in several parts they are added to this part, and no other part takes part; the next step
 * brings them home. MPM_E_FORMAT: the buffer is damaged; it is of another law, or of other parameters,
 * dimension, geometry or kind of grid, or counts images of other periods; or it has fields that the set has
 * not: of the host, of another type, or "reference_position" and "dilation_ratio" where no stepper keeps
 * them. MPM_E_ARG: an id is in use, or a particle lies outside the grid, which the text names; or buffer is
 * NULL. MPM_E_STATE: as for all that changes a set. Since 0.2.0.
 */
MPM_API mpm_status mpm_particles_unpack(mpm_particles *particles, const void *buffer, int64_t bytes);

#ifdef __cplusplus
}
#endif

#endif
