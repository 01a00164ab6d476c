/* Orders from JSON: {"do":"drive","vehicle":7,"throttle":0.5}. */
#ifndef JOLON_TOPICS_ORDER_JSON_H
#define JOLON_TOPICS_ORDER_JSON_H

#include "topics/order.h"

#include <cjson/cJSON.h>

/* Reads an order out of an object: its verb in "do", and an argument each by its name. "id", which
 * is the caller's own, is not looked at. -1 with the reason: what is wrong and what would be right.
 */
int order_from_json(struct order *order, const cJSON *object, struct reason *reason);

/* The same without order_end(): the caller may add what was not said. */
int order_json_give(struct order *order, const cJSON *object, struct reason *reason);

#endif
