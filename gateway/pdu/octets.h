/* Big-endian numbers at any address, as DIS writes them on the wire. Floats are IEEE 754. Pure. */
#ifndef JOLON_GATEWAY_PDU_OCTETS_H
#define JOLON_GATEWAY_PDU_OCTETS_H

#include <stdint.h>
#include <string.h>

static inline uint16_t octets_u16(const uint8_t *at)
{
    return (uint16_t)(at[0] << 8 | at[1]);
}

static inline uint32_t octets_u32(const uint8_t *at)
{
    return (uint32_t)octets_u16(at) << 16 | octets_u16(at + 2);
}

static inline float octets_f32(const uint8_t *at)
{
    uint32_t bits = octets_u32(at);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double octets_f64(const uint8_t *at)
{
    uint64_t bits = (uint64_t)octets_u32(at) << 32 | octets_u32(at + 4);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline void octets_put_u16(uint8_t *at, uint16_t value)
{
    at[0] = (uint8_t)(value >> 8);
    at[1] = (uint8_t)value;
}

static inline void octets_put_u32(uint8_t *at, uint32_t value)
{
    octets_put_u16(at, (uint16_t)(value >> 16));
    octets_put_u16(at + 2, (uint16_t)value);
}

static inline void octets_put_f32(uint8_t *at, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    octets_put_u32(at, bits);
}

static inline void octets_put_f64(uint8_t *at, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    octets_put_u32(at, (uint32_t)(bits >> 32));
    octets_put_u32(at + 4, (uint32_t)bits);
}

#endif
