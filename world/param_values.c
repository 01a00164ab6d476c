/* The words of the values of enumerated parameters. */
#include "world/param_values.h"

#include "world/enum_words.h"

#define X(name, value, word, test, text) [METHOD_##name] = #word,
WORDS(method_name, method, METHOD_COUNT, METHODS(X))
#undef X
WORDS(shape_name, shape, SHAPE_COUNT, "sphere", "model")
#define X(name, value, word, text) [MODEL_##name] = #word,
WORDS(response_model_name, response_model, MODEL_COUNT, RESPONSE_MODELS(X))
#undef X
