/**
 * @file parallel.h
 * One problem in several parts: each part is a context (in a process of its own, or a thread) with grid,
 * materials, sets and steppers made alike, and holds the particles of its own blocks of the grid. The host
 * lends each context a transport; the library says what has to go where, and never opens a connection.
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
  int32_t reserved; /**< 0 */
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

/** all[parts]: value of each part (collective). Only when the blocks are cut anew. Returns as mpm_send_fn. */
typedef mpm_status (*mpm_gather_fn)(void *user, int64_t value, int64_t *all);

/** Ways between the parts. All are called on the calling thread. */
typedef struct mpm_transport {
  uint32_t struct_size;   /**< sizeof(mpm_transport) of the caller */
  int32_t part;           /**< of this context, 0 ... parts - 1 */
  int32_t parts;          /**< how many there are */
  int32_t reserved;       /**< 0 */
  mpm_send_fn send;       /**< required, as the three that follow */
  mpm_receive_fn receive; /**< ends what send started */
  mpm_reduce_fn reduce;   /**< maxima and sums of integers */
  mpm_gather_fn gather;   /**< one integer of each part */
  /** Called every 50 microseconds or so between send and receive, for transports that move only when called;
   * may be NULL. */
  void (*poll)(void *user);
  void *user; /**< passed to all of them */
} mpm_transport;

/** Loads the state from count of its pieces (collective): part 0 the first few, part 1 those after, and so
 * on; count may be 0. How many parts saved them does not matter: continuing is the same bits. */
MPM_API mpm_status mpm_state_load_pieces(mpm_stepper *stepper, int32_t count, const void *const *piece,
                                         const int64_t *bytes);

#ifdef __cplusplus
}
#endif

#endif
