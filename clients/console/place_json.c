/* Answers with a place in all its forms. */
#include "clients/console/place_json.h"

#include "world/earth_place.h"

#define DEGREE_DECIMALS 7 /* 1 cm */

void place_json_put(struct json_writer *json, const struct params *params, double x, double z)
{
    struct place_frame frame;
    struct place_earth earth;
    earth_place_frame(&frame, params);
    place_earth(&earth, &frame, x, z);
    json_writer_key_number(json, "latitude_deg", earth.latitude_deg, DEGREE_DECIMALS);
    json_writer_key_number(json, "longitude_deg", earth.longitude_deg, DEGREE_DECIMALS);
    json_writer_key_word(json, "degrees", earth.degrees);
    json_writer_key_word(json, "mgrs", earth.mgrs);
}

void place_json(const struct world_query *query, struct http_answer *answer)
{
    struct json_writer *json = &answer->json;
    struct place place;
    struct place_frame frame;
    struct error_text error;
    double x, z;
    if (!world_query_attached(query, answer))
        return;
    const struct params *params = query->reader->view.world.params;
    earth_place_frame(&frame, params);
    if (place_read(&place, query_text(&query->arguments, "at"), &error) != 0 ||
        place_world(&place, &frame, &x, &z, &error) != 0) {
        http_answer_error(answer, HTTP_ANSWER_BAD,
                          "ask as at=25000,24000, at=44.2705N,71.3033W or at=19TCK1617404497",
                          "at: %s", error.text);
        return;
    }
    json_writer_begin(json, '{');
    json_writer_key_number(json, "x", x, 2);
    json_writer_key_number(json, "z", z, 2);
    place_json_put(json, params, x, z);
    json_writer_end(json, '}');
}
