/* A datagram for the DIS gateway. What is read must be written and read again as the same. */
#include "gateway/pdu/pdu_read.h"
#include "gateway/pdu/pdu_write.h"
#include "world/runtime/check.h"

#include <stdint.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct pdu pdu, again;
    static uint8_t bytes[PDU_BYTES_MAX], second[PDU_BYTES_MAX];
    static struct pdu_counts counts;
    struct pdu_cursor cursor = {data, size, 0};
    enum pdu_result result;
    size_t before = 0;
    while ((result = pdu_read(&cursor, &pdu)) != PDU_END) {
        CHECK(cursor.at > before && result < PDU_RESULTS);
        before = cursor.at;
        pdu_read_count(&counts, result, &pdu);
        if (result != PDU_GOOD)
            continue;
        if (pdu.header.version < 6)
            pdu.header.version = 6;
        size_t length = pdu_write(&pdu, bytes, sizeof bytes);
        CHECK(length >= PDU_HEADER_BYTES);
        struct pdu_cursor written = {bytes, length, 0};
        CHECK(pdu_read(&written, &again) == PDU_GOOD && written.at == length);
        CHECK(pdu_write(&again, second, sizeof second) == length);
        CHECK(memcmp(bytes, second, length) == 0);
    }
    return 0;
}
