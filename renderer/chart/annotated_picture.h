/* Annotated pictures: the map with its close-up, legend and figures, and the instruments over a
 * camera's picture. The painted ground and the glyphs are kept from picture to picture. */
#ifndef JOLON_RENDERER_CHART_ANNOTATED_PICTURE_H
#define JOLON_RENDERER_CHART_ANNOTATED_PICTURE_H

#include "renderer/chart/base_map.h"
#include "renderer/chart/map_layout.h"
#include "renderer/chart/map.h"
#include "renderer/image/text.h"
#include "renderer/scene/frame/statistics.h"

#include <stdbool.h>
#include <stdint.h>

/* What a picture shows; borrowed for one call. */
struct annotated_picture_source {
    const struct frame_view *frame_view;
    const struct tracks *tracks;
    const struct effects *effects; /* recent detonations; NULL for none */
    const struct camera *camera;   /* its view is the triangle; NULL: no triangle */
    uint32_t slot;                 /* of the followed vehicle, SLOT_NONE for none */
    double fps;                    /* pictures a second that the renderer makes; 0: not known */
};

/* A map within a picture, drawn into an image of its own. */
struct annotated_picture_inset {
    struct base_map base;
    struct image image;
};

struct annotated_picture {
    struct text *text; /* owned, unless it is shared */
    bool shares_text;  /* text belongs to another picture */
    const struct world *world;
    uint32_t width, height; /* of the pictures */
    struct map_layout layout;
    struct base_map whole;
    struct annotated_picture_inset close_up, small;
};

/* Returns 0, or -1 with the reason. Ground is painted later, when a picture first needs it, which
 * takes at most some tenths of a second. */
int annotated_picture_open(struct annotated_picture *picture, const struct world *world,
                           uint32_t width, uint32_t height, struct error_text *error);

/* Opens one for another size that shares the glyphs of first, which must outlive it. */
void annotated_picture_open_shared(struct annotated_picture *picture,
                                   const struct annotated_picture *first, uint32_t width,
                                   uint32_t height);
void annotated_picture_close(struct annotated_picture *picture);

/* Draws the map: the whole world and, where there is room, a close-up around the followed vehicle,
 * figures and a legend. Returns 0, or -1 with errno. */
int annotated_picture_map(struct annotated_picture *picture, struct image *image,
                          const struct annotated_picture_source *source);

/* --- for the files of chart/ ------------------------------------------------------------------ */

/* Gives the inset's image this size. Returns 0, or -1 with errno ENOMEM. */
int annotated_picture_inset_resize(struct annotated_picture_inset *inset, uint32_t width,
                                   uint32_t height);

/* Sizes of what is drawn on a map. */
struct annotated_picture_style {
    double symbol;   /* [pixel] length of symbols */
    double triangle; /* [pixel] length of the camera's triangle */
    uint8_t tracks;  /* opacity of tracks, 0: none */
};

/* Draws what lies below a map's labels: ground, craters, tracks, the camera's triangle. Returns 0,
 * or -1 with errno ENOMEM. */
int annotated_picture_ground(struct base_map *base, struct image *image,
                             const struct map_view *view,
                             const struct annotated_picture_source *source,
                             const struct annotated_picture_style *style);

/* Draws what lies above them: vehicles, fires, detonations, the followed vehicle's ring. */
void annotated_picture_symbols(struct image *image, const struct map_view *view,
                               const struct annotated_picture_source *source,
                               const struct annotated_picture_style *style);

/* Shortens a label in place until it takes at most width pixels. size: of the font [pixel]. */
void annotated_picture_shorten(struct annotated_picture *picture, char *label, uint32_t size,
                               int32_t width);

#endif
