//! Stored values read back by serde: through the check of the constructor, never around it.

/// Implements `serde::Deserialize`, with the feature `serde`, for a type whose constructor checks its fields.
///
/// `deserialize_checked! { Name { field: Type, .. } by check }`: the fields are those that the derived
/// `Serialize` writes, in its order. `check` makes a `Result<Self, _>` of a plain struct of them; what it
/// refuses is the deserializer's error, in the words of the constructor's error.
macro_rules! deserialize_checked {
    ($name:ident $(<$real:ident>)? { $($field:ident: $type:ty),* } by $check:expr) => {
        #[cfg(feature = "serde")]
        const _: () = {
            // Of the type's own name, which some formats write.
            #[derive(serde::Deserialize)]
            struct $name $(<$real: Real>)? {
                $($field: $type),*
            }

            impl<'de, $($real: Real + serde::Deserialize<'de>)?> serde::Deserialize<'de>
                for self::$name $(<$real>)?
            {
                fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                    let check: fn($name $(<$real>)?) -> Result<Self, _> = $check;
                    check(<$name $(<$real>)?>::deserialize(from)?).map_err(serde::de::Error::custom)
                }
            }
        };
    };
}
