//! Reads and writes frictional contact problems in the FCLIB form (HDF5).
