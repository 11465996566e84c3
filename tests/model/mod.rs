//! Models: containers as bytes, pictures beside those of draws by hand, poses beside those in double precision.

mod builder;
mod bytes;
mod clusters;
mod exact;
mod figures;
mod pictures;
mod places;
mod poses;
