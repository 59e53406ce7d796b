//! Work done with the widest instructions that the machine has.

/// Defines a function that does what `$anywhere` does (which has to be `#[inline(always)]`), with the widest
/// instructions that the machine has. All ways give the same bits: the wider ones do more at once, and round and
/// convert faster; multiplications and additions are never fused.
#[macro_export]
macro_rules! widest {
    (fn $name:ident $(<$life:lifetime>)? ($($given:ident: $kind:ty),*) -> $result:ty = $anywhere:path) => {
        fn $name $(<$life>)? ($($given: $kind),*) -> $result {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn with_avx2 $(<$life>)? ($($given: $kind),*) -> $result {
                    $anywhere($($given),*)
                }
                if ::std::arch::is_x86_feature_detected!("avx2") {
                    // SAFETY: the machine has AVX2.
                    return unsafe { with_avx2($($given),*) };
                }
            }
            $anywhere($($given),*)
        }
    };
}
