-- A store that the version before wrote, as text.
BEGIN TRANSACTION;
CREATE TABLE event (hash TEXT NOT NULL REFERENCES run, event INTEGER NOT NULL, height_m REAL, length_m REAL, head_m REAL, tail_m REAL, width_m REAL, volume_m3 REAL, density_kg_m3 REAL, on_panel_kg REAL, detached_kg REAL, body_height_m REAL, body_length_m REAL, mass_kg REAL, sim_time_s REAL, steps INTEGER, ended TEXT, crest_m REAL, body_head_m REAL, body_tail_m REAL, PRIMARY KEY (hash, event)) WITHOUT ROWID;
INSERT INTO "event" VALUES('eb6eaf93cd755c3af214460844234329',1,0.318458004,0.121961517,0.10233387,0.224295387,1.0,0.00490153311,209.934313,0.0,0.0,0.318458004,0.121961517,1.02899999,0.30354166,2826,'time_limit',0.10233387,0.10233387,0.224295387);
CREATE TABLE event_timing (hash TEXT NOT NULL REFERENCES run, event INTEGER NOT NULL, wall_s REAL, PRIMARY KEY (hash, event)) WITHOUT ROWID;
INSERT INTO "event_timing" VALUES('eb6eaf93cd755c3af214460844234329',1,1.91956527);
CREATE TABLE run (hash TEXT PRIMARY KEY, version TEXT NOT NULL, scene TEXT NOT NULL, status TEXT NOT NULL DEFAULT 'pending' CHECK (status IN ('pending', 'done', 'failed')), error TEXT, owner TEXT);
INSERT INTO "run" VALUES('eb6eaf93cd755c3af214460844234329','0.1.0','{"snowshed": 1, "dimension": 2, "title": "Laboratory experiment, Tables 2.3.1 and 4.1.1, calibrated snow", "gravity": 9.81, "snow": {"model": "cam_clay", "density": 210.0, "youngs_modulus": 1000000.0, "poissons_ratio": 0.3, "critical_state_slope": 0.5, "preconsolidation_pressure": 7000.0, "cohesion": 0.2, "hardening_factor": 0.1}, "panel": {"height": 0.33, "length": 0.245, "width": 0.213, "tilt": 50.0, "thickness": 0.0, "condition": "slip", "friction": 0.3}, "slab": {"thickness": 0.02, "length": 0.245, "width": 0.142, "layers": []}, "ground": {"tilt": 0.0, "condition": "sticky", "friction": 0.3}, "obstacles": [], "bodies": [], "seeding": {"particles_per_voxel": 4.0, "pattern": "poisson", "seed": 1, "allow_sparse": false}, "numerics": {"dx": 0.02, "precision": "float", "transfer": "flip", "flip_ratio": 0.99, "basis": "quadratic", "step_factor": 0.9, "strain_limit": 0.2, "sleep_speed": 0.02, "sleep_time": 0.04, "threads": 0}, "events": {"count": 2, "between": "carry", "max_time": 0.3, "rest_speed": 0.02, "rest_time": 0.05}, "output": {"snapshot_interval": 0.0, "energy": false, "checkpoint_interval": 60.0}}','done',NULL,NULL);
CREATE TABLE run_timing (hash TEXT PRIMARY KEY REFERENCES run, run_wall_s REAL, threads INTEGER, particles INTEGER, particle_updates INTEGER, peak_memory_mb REAL, host TEXT, cpu TEXT, finished TEXT);
INSERT INTO "run_timing" VALUES('eb6eaf93cd755c3af214460844234329',1.9,1,NULL,NULL,NULL,NULL,NULL,NULL);
CREATE TABLE study (name TEXT PRIMARY KEY, axes TEXT NOT NULL);
INSERT INTO "study" VALUES('friction','["panel.friction"]');
CREATE TABLE study_run (study TEXT NOT NULL REFERENCES study, position INTEGER NOT NULL, hash TEXT NOT NULL REFERENCES run, PRIMARY KEY (study, position)) WITHOUT ROWID;
INSERT INTO "study_run" VALUES('friction',0,'eb6eaf93cd755c3af214460844234329');
CREATE INDEX run_owner ON run (owner) WHERE owner IS NOT NULL;
COMMIT;
PRAGMA application_id = 1397641047;
PRAGMA user_version = 1;
