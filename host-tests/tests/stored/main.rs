//! What firmware stores and sends, by serde: it comes back as it was, as JSON and as postcard's bytes, and
//! what a constructor refuses is refused when it is read.

mod refused;
mod round_trips;
