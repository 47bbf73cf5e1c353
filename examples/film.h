/* A film strip: positions of the particles of a plane at some moments, drawn side by side as squares. */
#ifndef EXAMPLES_FILM_H
#define EXAMPLES_FILM_H

#include <stdlib.h>

#include "svg.h"

enum { FILM_MOST = 8 };

/* Arrays are [components][n]. */
typedef struct film {
  int64_t n;
  int count;   /* frames taken */
  double edge; /* of a particle */
  double t[FILM_MOST];
  double *x[FILM_MOST], *value[FILM_MOST]; /* x[2][n], value[n] */
} film;

static inline film film_of(int64_t n, double edge) {
  return (film){.n = n, .edge = edge};
}

static inline void film_close(film *f) {
  for (int k = 0; k < f->count; ++k) free(f->x[k]);
}

/* Another frame, to be filled by the caller; -1 when there is no memory, or no room. */
static inline int film_frame(film *f, double t) {
  if (f->count == FILM_MOST) return -1;
  double *x = malloc(3 * (size_t)f->n * sizeof *x);
  if (!x) return -1;
  f->x[f->count] = x;
  f->value[f->count] = x + 2 * f->n;
  f->t[f->count] = t;
  return f->count++;
}

/* What the frames show, in data coordinates, and how they are laid out: columns of panels of this width. */
typedef struct film_view {
  double x_min, x_max, y_min, y_max;
  int columns;
  double panel;      /* width in pixels */
  double value_max;  /* for the colours */
  const char *title; /* of the colour bar; NULL: there is none */
  /* Draws what stands still; NULL: there is nothing */
  void (*scenery)(FILE *out, const svg_frame *frame, const void *user);
  const void *user;
} film_view;

/* 0 when the picture has been written. */
static inline int film_draw(const film *f, const film_view *v, const char *path) {
  const double gap = 16.0, head = 30.0, height = v->panel * (v->y_max - v->y_min) / (v->x_max - v->x_min);
  const int lines = (f->count + v->columns - 1) / v->columns;
  const double wide = v->columns * (v->panel + gap) + gap, high = lines * (height + head + gap);
  FILE *out = svg_open(path, (int)(wide + 0.5), (int)(high + (v->title ? 62.0 : 4.0)));
  for (int k = 0; k < f->count; ++k) {
    const svg_frame frame = {gap + (v->panel + gap) * (k % v->columns),
                             head + (height + head + gap) * (k / v->columns),
                             v->panel,
                             height,
                             v->x_min,
                             v->x_max,
                             v->y_min,
                             v->y_max};
    char text[64];
    const int is_short = f->t[f->count - 1] < 0.1;
    snprintf(text, sizeof text, "<tspan font-weight=\"bold\">t = %.*f %s</tspan>", is_short ? 0 : 2,
             f->t[k] * (is_short ? 1e3 : 1.0), is_short ? "ms" : "s");
    svg_text(out, frame.left + 0.5 * v->panel, frame.top - 10.0, "middle", "", text);
    svg_panel(out, &frame);
    svg_squares(out, &frame, f->n, f->x[k], f->edge, f->value[k], v->value_max);
    if (v->scenery) v->scenery(out, &frame, v->user);
  }
  if (v->title) svg_colour_bar(out, 0.5 * wide - 150.0, high + 22.0, 300.0, v->value_max, v->title);
  return svg_close(out);
}

#endif
