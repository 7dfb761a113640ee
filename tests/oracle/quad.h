#pragma once

namespace oracle {

/// 113 bits of significand and 15 of exponent.
#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Quad;
#else  // where long double is that, as on 64-bit ARM
using Quad = long double;
static_assert(__LDBL_MANT_DIG__ == 113);
#endif

}  // namespace oracle
