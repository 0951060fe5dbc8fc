// Which samples the lanes of a packet take. Receivers want different numbers of samples: with one lane for each of
// them, most would wait for the one that wants most. So whole packets of one receiver's samples are taken first, whose
// rays also stay closer together than those of neighbours; then what is left, a lane for each receiver if that leaves
// few of them idle. What becomes of a sample does not depend on the lane that takes it: sinks (sinks/sums.h) are given
// those of a receiver in their order.
#ifndef WEDGE_DEAL_H
#define WEDGE_DEAL_H

#include "core/packet_size.h"
#include "shared/compat.h"

/// Part of the lanes that are to be busy where each lane keeps its own receiver: it saves dealReceivers().
#define WEDGE_OWN_SHARE 0.5f

/// Samples that a packet's receivers have and are to have.
typedef struct {
    uint first[WEDGE_PACKET_SIZE], next[WEDGE_PACKET_SIZE]; ///< before this launch, and dealt so far
    uint last[WEDGE_PACKET_SIZE]; ///< after this launch
    uint strata[WEDGE_PACKET_SIZE]; ///< that strata are made for
} Wanted;

/// What lanes take in the next `steps` steps.
typedef struct {
    uint receiver[WEDGE_PACKET_SIZE]; ///< whose sample a lane takes
    uint index[WEDGE_PACKET_SIZE]; ///< which one of its; none from `last` on
    uint last[WEDGE_PACKET_SIZE], count[WEDGE_PACKET_SIZE]; ///< the receiver's Wanted::last and strata
    uint stride; ///< from a lane's sample to its next
    uint steps;
    bool own; ///< receiver[lane] == lane
    bool whole; ///< all lanes take samples of one receiver, none of them is idle
} Deal;

WEDGE_INLINE uint samplesLeft(const Wanted* wanted, uint receiver)
{
    return wanted->last[receiver] - min(wanted->next[receiver], wanted->last[receiver]);
}

/// All whole packets of samples of the receiver.
WEDGE_FN void dealWhole(Wanted* wanted, uint receiver, Deal* deal)
{
    deal->own = false;
    deal->whole = true;
    deal->stride = WEDGE_PACKET_SIZE;
    deal->steps = samplesLeft(wanted, receiver) / WEDGE_PACKET_SIZE;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        deal->receiver[lane] = receiver;
        deal->index[lane] = wanted->next[receiver] + lane;
    }
    wanted->next[receiver] += deal->steps * WEDGE_PACKET_SIZE;
}

/// All samples, a lane for each receiver.
WEDGE_FN void dealOwn(Wanted* wanted, uint steps, Deal* deal)
{
    deal->own = true;
    deal->whole = false;
    deal->stride = 1u;
    deal->steps = steps;
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        deal->receiver[lane] = lane;
        deal->index[lane] = wanted->next[lane];
        wanted->next[lane] = max(wanted->next[lane], wanted->last[lane]);
    }
}

/// One packet of what receivers have left, one after the other.
WEDGE_FN void dealRest(Wanted* wanted, Deal* deal)
{
    deal->own = deal->whole = false;
    deal->stride = 1u;
    deal->steps = 1u;
    uint lane = 0u;
    for (uint r = 0u; r < WEDGE_PACKET_SIZE; ++r) {
        for (; lane < WEDGE_PACKET_SIZE && wanted->next[r] < wanted->last[r]; ++lane) {
            deal->receiver[lane] = r;
            deal->index[lane] = wanted->next[r]++;
        }
    }
    for (; lane < WEDGE_PACKET_SIZE; ++lane) {
        deal->receiver[lane] = 0u;
        deal->index[lane] = wanted->last[0];
    }
}

/// Deals the next samples; false where none is left.
WEDGE_FN bool dealSamples(Wanted* wanted, Deal* deal)
{
    uint total = 0u, most = 0u, whole = WEDGE_PACKET_SIZE;
    for (uint r = 0u; r < WEDGE_PACKET_SIZE; ++r) {
        const uint left = samplesLeft(wanted, r);
        total += left;
        most = max(most, left);
        whole = left >= WEDGE_PACKET_SIZE ? r : whole;
    }
    if (total == 0u) {
        return false;
    }
    const bool several = WEDGE_PACKET_SIZE > 1u;
    if (several && whole < WEDGE_PACKET_SIZE) {
        dealWhole(wanted, whole, deal);
    } else if ((float)total >= WEDGE_OWN_SHARE * (float)(most * WEDGE_PACKET_SIZE)) {
        dealOwn(wanted, most, deal);
    } else {
        dealRest(wanted, deal);
    }
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        deal->last[lane] = wanted->last[deal->receiver[lane]];
        deal->count[lane] = wanted->strata[deal->receiver[lane]];
    }
    return true;
}

/// The next of the deal's steps. Lanes whose receivers have all their samples wait for the others.
WEDGE_INLINE void nextStep(Deal* deal)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        deal->index[lane] = min(deal->index[lane] + deal->stride, deal->last[lane]);
    }
}

/// Moves what was counted in each lane to its receiver's count.
WEDGE_INLINE void moveToReceivers(const Deal* deal, uint* lanes, uint* receivers)
{
    for (uint lane = 0u; lane < WEDGE_PACKET_SIZE; ++lane) {
        receivers[deal->receiver[lane]] += lanes[lane];
        lanes[lane] = 0u;
    }
}

#endif
