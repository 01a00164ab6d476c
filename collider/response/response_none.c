/* The response "none": collisions are only reported. */
#include "collider/response/response.h"

const struct response_functions response_none = {0};
