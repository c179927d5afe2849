//! Planes, solids and the surfaces of every kind of primitive, against an oracle that knows shapes
//! only by a sign.

mod coordinates;
mod leaving;
mod oracle;
mod solids;
