/* The table of measures, and the worst values. */
#include "supervisor/physics/measure.h"

static const struct {
    const char *word, *unit, *meaning;
    double bound;
} table[] = {
#define X(name, word, unit, bound, meaning) {#word, unit, meaning, bound},
    MEASURES(X)
#undef X
};

const char *measure_word(enum measure_kind kind)
{
    return table[kind].word;
}

const char *measure_unit(enum measure_kind kind)
{
    return table[kind].unit;
}

const char *measure_meaning(enum measure_kind kind)
{
    return table[kind].meaning;
}

double measure_bound(const struct measures *measures, enum measure_kind kind)
{
    return measures->of[kind].unbound ? NO_BOUND : table[kind].bound;
}

void measure_take(struct measures *measures, enum measure_kind kind, double value,
                  const struct measured_body *a, const struct measured_body *b)
{
    struct measure *measure = &measures->of[kind];
    if (isnan(value))
        value = HUGE_VAL;
    measure->taken++;
    if (value > measure_bound(measures, kind))
        measure->beyond++;
    if (measure->taken > 1 && value <= measure->worst)
        return;
    measure->worst = value;
    measure->frame = measures->frame;
    measure->time_s = measures->time_s;
    measure->body[0] = a ? *a : (struct measured_body){0};
    measure->body[1] = b ? *b : (struct measured_body){0};
}

bool measure_good(const struct measures *measures, enum measure_kind kind)
{
    return measures->of[kind].beyond == 0;
}

bool measures_good(const struct measures *measures)
{
    for (int i = 0; i < MEASURE_KINDS; i++) {
        if (!measure_good(measures, (enum measure_kind)i))
            return false;
    }
    return true;
}
