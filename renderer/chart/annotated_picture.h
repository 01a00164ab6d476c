/* Pictures with words: the map with its close-up, legend and figures, and the instruments laid over
 * a camera's picture. What stays the same from picture to picture is kept: the ground, and letters.
 */
#ifndef JOLON_RENDERER_CHART_ANNOTATED_PICTURE_H
#define JOLON_RENDERER_CHART_ANNOTATED_PICTURE_H

#include "renderer/chart/base_map.h"
#include "renderer/chart/map_layout.h"
#include "renderer/chart/map.h"
#include "renderer/image/text.h"
#include "renderer/scene/frame/statistics.h"

#include <stdbool.h>
#include <stdint.h>

/* What a picture is taken from; borrowed for one call. */
struct annotated_picture_source {
    const struct frame_view *frame_view;
    const struct tracks *tracks;
    const struct effects *effects; /* recent detonations; NULL for none */
    const struct camera *camera;   /* whose view the triangle shows; NULL: no triangle */
    uint32_t slot;                 /* of the followed vehicle, SLOT_NONE for none */
    double fps;                    /* pictures a second that the renderer makes; 0: not known */
};

/* A map within a picture: its ground, and an image of its own to be drawn in. */
struct annotated_picture_inset {
    struct base_map base;
    struct image image;
};

struct annotated_picture {
    struct text *text; /* owned, unless it is another's */
    bool shares_text;  /* it is */
    const struct world *world;
    uint32_t width, height; /* of the pictures */
    struct map_layout layout;
    struct base_map whole, area;
    struct annotated_picture_inset close_up, small;
};

/* 0, or -1 with the reason. Quick: ground is painted when a picture first needs it, at most some
 * tenths of a second. */
int annotated_picture_open(struct annotated_picture *picture, const struct world *world,
                           uint32_t width, uint32_t height, struct error_text *error);
/* One for pictures of another size, with the letters of the first, which must outlive it. */
void annotated_picture_open_shared(struct annotated_picture *picture,
                                   const struct annotated_picture *first, uint32_t width,
                                   uint32_t height);
void annotated_picture_close(struct annotated_picture *picture);

/* The map as a picture: the whole square, and as the picture's size and aspect have room, a
 * close-up around the followed vehicle, its figures, and a legend. 0, or -1 with errno. */
int annotated_picture_map(struct annotated_picture *picture, struct image *image,
                          const struct annotated_picture_source *source);

/* A map of one place that fills the picture: centre [m, world], and metres a pixel. To pan is to
 * change the centre, and costs what comes into view; to zoom is to change metres, and paints all
 * anew. 0, or -1 with errno. */
int annotated_picture_area(struct annotated_picture *picture, struct image *image,
                           const struct annotated_picture_source *source, double x, double z,
                           double metres);

/* --- for the files of chart/ ------------------------------------------------------------------ */

/* Makes a part's image of a size, unless it is. 0, or -1 with errno ENOMEM. */
int annotated_picture_inset_resize(struct annotated_picture_inset *part, uint32_t width,
                                   uint32_t height);

/* How a map is drawn. */
struct annotated_picture_style {
    double symbol;   /* [pixel] length of symbols */
    double triangle; /* [pixel] of the viewing triangle */
    uint8_t tracks;  /* opacity, 0: without */
};

/* What lies below a map's words: ground, craters, tracks, what the camera sees. 0, or -1 with
 * errno ENOMEM. */
int annotated_picture_ground(struct base_map *base, struct image *image,
                             const struct map_view *view,
                             const struct annotated_picture_source *source,
                             const struct annotated_picture_style *style);

/* What lies above them: vehicles, fires, detonations, the followed vehicle's ring. */
void annotated_picture_symbols(struct image *image, const struct map_view *view,
                               const struct annotated_picture_source *source,
                               const struct annotated_picture_style *style);

/* Words, shortened until they take at most width pixels. */
void annotated_picture_shorten(struct annotated_picture *picture, char *label, uint32_t size,
                               int32_t width);

#endif
