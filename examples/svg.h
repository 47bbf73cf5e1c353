/* Pictures for the examples: frames with axes, curves, tiles coloured by a value, a colour bar. Plain SVG
 * text, no dependency. Drawing into a file that could not be written is harmless: svg_close reports it. */
#ifndef EXAMPLES_SVG_H
#define EXAMPLES_SVG_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>

#define SVG_INK  "#24292f"
#define SVG_GRID "#e6e9ed"

/* A frame maps data coordinates to a rectangle of the picture. */
typedef struct svg_frame {
  double left, top, width, height;   /* pixels */
  double x_min, x_max, y_min, y_max; /* data */
} svg_frame;

static inline double svg_x(const svg_frame *f, double x) {
  return f->left + f->width * (x - f->x_min) / (f->x_max - f->x_min);
}

static inline double svg_y(const svg_frame *f, double y) {
  return f->top + f->height * (f->y_max - y) / (f->y_max - f->y_min);
}

static inline FILE *svg_open(const char *path, int width, int height) {
  FILE *out = fopen(path, "w");
  if (!out) return NULL;
  fprintf(out,
          "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" width=\"%d\" height=\"%d\" "
          "font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"" SVG_INK "\">\n"
          "<rect width=\"%d\" height=\"%d\" rx=\"8\" fill=\"#ffffff\"/>\n",
          width, height, width, height, width, height);
  return out;
}

/* 0 when everything has been written. */
static inline int svg_close(FILE *out) {
  if (!out) return -1;
  fputs("</svg>\n", out);
  const int failed = ferror(out);
  return fclose(out) || failed ? -1 : 0;
}

/* anchor: "start", "middle" or "end". */
static inline void svg_text(FILE *out, double x, double y, const char *anchor, const char *style,
                            const char *text) {
  if (out)
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" %s>%s</text>\n", x, y, anchor, style, text);
}

/* The step 1, 2 or 5 times a power of ten that cuts the range into about `count` pieces. */
static inline double svg_tick(double range, int count) {
  const double power = pow(10.0, floor(log10(range / count)));
  const double lead = range / count / power;
  return power * (lead < 1.5 ? 1.0 : lead < 3.5 ? 2.0 : lead < 7.5 ? 5.0 : 10.0);
}

/* Border, ticks with numbers, and titles of the axes. */
static inline void svg_axes(FILE *out, const svg_frame *f, const char *x_title, const char *y_title) {
  if (!out) return;
  const double right = f->left + f->width, bottom = f->top + f->height;
  const double dx = svg_tick(f->x_max - f->x_min, 8), dy = svg_tick(f->y_max - f->y_min, 6);
  for (double i = ceil(f->x_min / dx - 1e-9); i * dx <= f->x_max + 1e-9 * dx; i += 1.0) {
    const double x = svg_x(f, i * dx);
    fprintf(out,
            "<path d=\"M%.1f %.1fV%.1f\" stroke=\"" SVG_GRID "\"/>"
            "<path d=\"M%.1f %.1fv5\" stroke=\"" SVG_INK "\"/>"
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%g</text>\n",
            x, f->top, bottom, x, bottom, x, bottom + 20.0, i == 0.0 ? 0.0 : i * dx);
  }
  for (double i = ceil(f->y_min / dy - 1e-9); i * dy <= f->y_max + 1e-9 * dy; i += 1.0) {
    const double y = svg_y(f, i * dy);
    fprintf(out,
            "<path d=\"M%.1f %.1fH%.1f\" stroke=\"" SVG_GRID "\"/>"
            "<path d=\"M%.1f %.1fh-5\" stroke=\"" SVG_INK "\"/>"
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n",
            f->left, y, right, f->left, y, f->left - 9.0, y + 4.5, i == 0.0 ? 0.0 : i * dy);
  }
  fprintf(out,
          "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" stroke=\"" SVG_INK
          "\"/>\n"
          "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n"
          "<text transform=\"translate(%.1f %.1f) rotate(-90)\" text-anchor=\"middle\">%s</text>\n",
          f->left, f->top, f->width, f->height, f->left + 0.5 * f->width, bottom + 42.0, x_title,
          f->left - 46.0, f->top + 0.5 * f->height, y_title);
}

/* A plain background for a frame without axes. */
static inline void svg_panel(FILE *out, const svg_frame *f) {
  if (out)
    fprintf(
        out,
        "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"#f6f8fa\" stroke=\"#d0d7de\"/>\n",
        f->left, f->top, f->width, f->height);
}

/* What is drawn until svg_end_clip() shows inside the frame only. */
static inline void svg_clip(FILE *out, const svg_frame *f) {
  if (out)
    fprintf(out,
            "<clipPath id=\"in%.0f-%.0f\"><rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" "
            "height=\"%.1f\"/></clipPath>\n"
            "<g clip-path=\"url(#in%.0f-%.0f)\">\n",
            f->left, f->top, f->left, f->top, f->width, f->height, f->left, f->top);
}
static inline void svg_end_clip(FILE *out) {
  if (out) fputs("</g>\n", out);
}

static inline void svg_curve(FILE *out, const svg_frame *f, int n, const double *x, const double *y,
                             const char *colour) {
  if (!out) return;
  fprintf(out, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"2.2\" stroke-linejoin=\"round\" d=\"",
          colour);
  for (int i = 0; i < n; ++i) fprintf(out, "%s%.1f %.1f", i ? "L" : "M", svg_x(f, x[i]), svg_y(f, y[i]));
  fputs("\"/>\n", out);
}

/* Rings about points (x, y). */
static inline void svg_circles(FILE *out, const svg_frame *f, int n, const double (*at)[2],
                               const char *colour) {
  for (int i = 0; out && i < n; ++i)
    fprintf(out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\"/>\n",
            svg_x(f, at[i][0]), svg_y(f, at[i][1]), colour);
}

/* The viridis colour map, 0 <= s <= 1. */
enum { SVG_STOPS = 9 };
static inline void svg_colour(double s, int rgb[3]) {
  static const double stop[SVG_STOPS][3] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                            {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                            {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
  const double at = (SVG_STOPS - 1) * (s > 0.0 ? s < 1.0 ? s : 1.0 : 0.0);
  const int k = at < SVG_STOPS - 1 ? (int)at : SVG_STOPS - 2;
  for (int c = 0; c < 3; ++c) rgb[c] = (int)(stop[k][c] + (at - k) * (stop[k + 1][c] - stop[k][c]) + 0.5);
}

/* Parallelograms with centre x[c * n + i] and half edges a[c * n + i], b[c * n + i], coloured by value /
 * value_max. Tiles of one colour share a path, which keeps the file small. */
static inline void svg_tiles(FILE *out, const svg_frame *f, int64_t n, const double *x, const double *a,
                             const double *b, const double *value, double value_max) {
  enum { COLOURS = 48 };
  if (!out) return;
  const double px = f->width / (f->x_max - f->x_min), py = -f->height / (f->y_max - f->y_min);
  for (int k = 0; k < COLOURS; ++k) {
    int rgb[3], used = 0;
    svg_colour((k + 0.5) / COLOURS, rgb);
    for (int64_t i = 0; i < n; ++i) {
      const double at = COLOURS * value[i] / value_max;
      const int colour = at >= COLOURS ? COLOURS - 1 : at > 0.0 ? (int)at : 0;
      if (colour != k) continue;
      /* the stroke hides the seams that antialiasing would leave between tiles */
      if (!used++)
        fprintf(out, "<path fill=\"#%02x%02x%02x\" stroke=\"#%02x%02x%02x\" stroke-width=\".5\" d=\"",
                (unsigned)rgb[0], (unsigned)rgb[1], (unsigned)rgb[2], (unsigned)rgb[0], (unsigned)rgb[1],
                (unsigned)rgb[2]);
      fprintf(out, "M%.1f %.1fl%.1f %.1f %.1f %.1f %.1f %.1fz", svg_x(f, x[i] - a[i] - b[i]),
              svg_y(f, x[n + i] - a[n + i] - b[n + i]), 2.0 * px * a[i], 2.0 * py * a[n + i], 2.0 * px * b[i],
              2.0 * py * b[n + i], -2.0 * px * a[i], -2.0 * py * a[n + i]);
    }
    if (used) fputs("\"/>\n", out);
  }
}

/* Squares about x[c * n + i] of an edge in data coordinates, coloured by value / value_max. Each is a short
 * stroke with square ends, whole tenths of a pixel from the one before, which keeps the file small. */
static inline void svg_squares(FILE *out, const svg_frame *f, int64_t n, const double *x, double edge,
                               const double *value, double value_max) {
  enum { COLOURS = 48 };
  if (!out) return;
  const double scale = 10.0 * f->width / (f->x_max - f->x_min);
  for (int k = 0; k < COLOURS; ++k) {
    long pen[2] = {0, 0};
    int rgb[3], used = 0;
    svg_colour((k + 0.5) / COLOURS, rgb);
    for (int64_t i = 0; i < n; ++i) {
      const double at = COLOURS * value[i] / value_max;
      const int colour = at >= COLOURS ? COLOURS - 1 : at > 0.0 ? (int)at : 0;
      if (colour != k) continue;
      /* half a pixel more hides the seams that antialiasing would leave */
      if (!used++)
        fprintf(out,
                "<path transform=\"scale(.1)\" fill=\"none\" stroke-linecap=\"square\" "
                "stroke=\"#%02x%02x%02x\" stroke-width=\"%.1f\" d=\"",
                (unsigned)rgb[0], (unsigned)rgb[1], (unsigned)rgb[2], edge * scale + 5.0);
      const long to[2] = {lround(10.0 * svg_x(f, x[i])), lround(10.0 * svg_y(f, x[n + i]))};
      fprintf(out, "m%ld %ldh1", to[0] - pen[0], to[1] - pen[1]);
      pen[0] = to[0] + 1;
      pen[1] = to[1];
    }
    if (used) fputs("\"/>\n", out);
  }
}

/* Half edges half[c * n + i] along an axis of squares of that width, deformed by F[9][n]. */
static inline void svg_edges(int64_t n, double width, const double *F, int axis, double *half) {
  for (int c = 0; c < 2; ++c)
    for (int64_t i = 0; i < n; ++i) half[c * n + i] = 0.5 * width * F[(3 * c + axis) * n + i];
}

/* Particles of a lattice that bends little, as thick strokes: x[c * n + i] is a centre, half[c * n + i] half
 * of the edge towards the next of its row, and width the other edge, in data coordinates. colour[i] is one of
 * rgb; those below 0 are left out. Neighbours in a row that are of one colour share a stroke, and coordinates
 * are whole tenths of a pixel from the stroke before, which keeps the file small. */
static inline void svg_rows(FILE *out, const svg_frame *f, int64_t n, const double *x, const double *half,
                            double width, const int *colour, int colours, int (*rgb)[3]) {
  enum { LONGEST = 12 };
  if (!out) return;
  const double scale = f->width / (f->x_max - f->x_min), overlap = 1.0 + 0.8 / (scale * width);
  for (int k = 0; k < colours; ++k) {
    long pen[2] = {0, 0};
    int used = 0;
    for (int64_t i = 0, last; i < n; i = last + 1) {
      last = i;
      if (colour[i] != k) continue;
      while (last + 1 < n && last + 1 < i + LONGEST && colour[last + 1] == k &&
             hypot(x[last + 1] - x[last], x[n + last + 1] - x[n + last]) < 3.0 * hypot(half[i], half[n + i]))
        ++last;
      /* the overlap hides the seams that antialiasing would leave between strokes */
      if (!used++)
        fprintf(
            out,
            "<path transform=\"scale(.1)\" fill=\"none\" stroke=\"#%02x%02x%02x\" stroke-width=\"%.1f\" d=\"",
            (unsigned)rgb[k][0], (unsigned)rgb[k][1], (unsigned)rgb[k][2], 10.0 * overlap * scale * width);
      const long from[2] = {lround(10.0 * svg_x(f, x[i] - overlap * half[i])),
                            lround(10.0 * svg_y(f, x[n + i] - overlap * half[n + i]))},
                 to[2] = {lround(10.0 * svg_x(f, x[last] + overlap * half[last])),
                          lround(10.0 * svg_y(f, x[n + last] + overlap * half[n + last]))};
      fprintf(out, "m%ld %ldl%ld %ld", from[0] - pen[0], from[1] - pen[1], to[0] - from[0], to[1] - from[1]);
      for (int c = 0; c < 2; ++c) pen[c] = to[c];
    }
    if (used) fputs("\"/>\n", out);
  }
}

/* A rigid disc, of a radius in data coordinates. */
static inline void svg_disc(FILE *out, const svg_frame *f, double x, double y, double radius) {
  if (out)
    fprintf(out, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" fill=\"#8c959f\" stroke=\"" SVG_INK "\"/>\n",
            svg_x(f, x), svg_y(f, y), radius * f->width / (f->x_max - f->x_min));
}

/* An arrow of (dx, dy) pixels from a point of the data; none when it would be all head. */
static inline void svg_arrow(FILE *out, const svg_frame *f, double x, double y, double dx, double dy,
                             const char *colour) {
  const double length = sqrt(dx * dx + dy * dy);
  if (!out || length < 12.0) return;
  const double ex = dx / length, ey = dy / length, x0 = svg_x(f, x), y0 = svg_y(f, y), x1 = x0 + dx,
               y1 = y0 + dy;
  fprintf(out,
          "<path d=\"M%.1f %.1fL%.1f %.1f\" stroke=\"%s\" stroke-width=\"2.4\"/>"
          "<path d=\"M%.1f %.1fL%.1f %.1fL%.1f %.1fz\" fill=\"%s\"/>\n",
          x0, y0, x1 - 5.0 * ex, y1 - 5.0 * ey, colour, x1, y1, x1 - 9.0 * ex - 4.5 * ey,
          y1 - 9.0 * ey + 4.5 * ex, x1 - 9.0 * ex + 4.5 * ey, y1 - 9.0 * ey - 4.5 * ex, colour);
}

/* A horizontal colour bar for 0 ... value_max, title above, larger values like the last; one in a picture. */
static inline void svg_colour_bar(FILE *out, double left, double top, double width, double value_max,
                                  const char *title) {
  if (!out) return;
  fputs("<linearGradient id=\"bar\">", out);
  for (int k = 0; k < SVG_STOPS; ++k) {
    int rgb[3];
    svg_colour((double)k / (SVG_STOPS - 1), rgb);
    fprintf(out, "<stop offset=\"%g\" stop-color=\"rgb(%d,%d,%d)\"/>", (double)k / (SVG_STOPS - 1), rgb[0],
            rgb[1], rgb[2]);
  }
  fprintf(
      out,
      "</linearGradient>\n<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"12\" fill=\"url(#bar)\"/>\n",
      left, top, width);
  const double step = svg_tick(value_max, 5);
  for (double i = 0.0; i * step <= value_max; i += 1.0)
    fprintf(out,
            "<path d=\"M%.1f %.1fv4\" stroke=\"" SVG_INK "\"/>"
            "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%g</text>\n",
            left + width * i * step / value_max, top + 12.0, left + width * i * step / value_max, top + 29.0,
            i * step);
  svg_text(out, left + 0.5 * width, top - 8.0, "middle", "", title);
}

#endif
