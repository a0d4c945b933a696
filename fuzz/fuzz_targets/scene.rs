//! Any bytes as a scene file: read, resolved, made into a model. Nothing may panic, hang or take memory without bound.
#![no_main]

use libfuzzer_sys::fuzz_target;
use teeter_scenario::simulation::Simulation;

fuzz_target!(|bytes: &[u8]| {
    match teeter_scenario::load(bytes, "scene.toml", "scene", &[]) {
        Err(found) => assert!(found.has_errors() && !found.to_string().is_empty()),
        Ok(resolved) => {
            if let Err(error) = Simulation::new(&resolved.scene) {
                assert!(!error.diagnostic(&resolved.document).to_string().is_empty());
            }
        }
    }
});
