//! The jobs that docs/scale.md shows for several machines, each part run as its scheduler would run it.

use crate::programs;
use crate::workshop::Workshop;
use std::fs;
use std::path::Path;
use std::process::Command;

const PARTS: usize = 16;

/// Four stands at twelve sites, certified long ago and for long, and the names that the documentation uses.
fn fleet() -> Workshop {
    let workshop = Workshop::new(4, 12);
    for number in 0..4 {
        let name = format!("stands/{number:04}/stand.yaml");
        let text = fs::read_to_string(workshop.path(&name)).unwrap();
        workshop.write(&name, &text.replace("\"2026-", "\"2020-").replace("\"2028-", "\"2098-"));
    }
    let signers = workshop.read("allowed_signers");
    workshop.write("allowed_signers", &signers.replacen("factory ", "factory@example.org ", 1));
    fs::rename(workshop.path("key"), workshop.path("factory.key")).unwrap();
    workshop
}

/// A shell in the workshop that finds the program by its name.
fn shell(workshop: &Workshop, script: &str) -> Command {
    let program = Path::new(env!("CARGO_BIN_EXE_dtg-passport")).parent().unwrap().to_owned();
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths([program].into_iter().chain(std::env::split_paths(&folders))).unwrap();
    let mut command = workshop.shell(script);
    command.env("PATH", path);
    command
}

/// The fleet is whole, and every passport was issued by one part.
fn whole(workshop: &Workshop) {
    let ids = workshop.sound("passports");
    assert_eq!(ids.len(), 48);
    let reports = fs::read_dir(workshop.path(".")).unwrap().map(|entry| entry.unwrap().path());
    let reports = reports.filter(|path| path.file_name().unwrap().to_string_lossy().starts_with("report-"));
    let reports: Vec<String> = reports.map(|path| fs::read_to_string(path).unwrap()).collect();
    assert_eq!(reports.len(), PARTS);
    let issued = reports.iter().flat_map(|report| report.lines()).filter(|line| line.starts_with("issued,"));
    assert_eq!(issued.count(), 48);
}

#[test]
fn gnu_parallel() {
    let page = fs::read_to_string(programs::project("docs/scale.md")).unwrap();
    let line = page.lines().find(|line| line.starts_with("parallel ")).unwrap();
    let workshop = fleet();
    // This machine alone, without ssh.
    workshop.write("machines", ":\n");
    programs::on_path("parallel");
    programs::output(shell(&workshop, line));
    whole(&workshop);
}

#[test]
fn slurm_array() {
    let script = fs::read_to_string(programs::project("docs/fleet.sbatch")).unwrap();
    assert!(script.contains(&format!("#SBATCH --array=1-{PARTS}\n")));
    let workshop = fleet();
    for task in 1..=PARTS {
        let mut command = shell(&workshop, &script);
        command.env("SLURM_ARRAY_TASK_ID", task.to_string()).env("SLURM_CPUS_PER_TASK", "2");
        programs::output(command);
    }
    whole(&workshop);
}

#[test]
fn kubernetes_indexed_job() {
    let job = fs::read_to_string(programs::project("docs/fleet-job.yaml")).unwrap();
    let job: serde_yaml::Value = serde_yaml::from_str(&job).unwrap();
    let spec = &job["spec"];
    let container = &spec["template"]["spec"]["containers"][0];
    assert_eq!((&job["kind"], &spec["completionMode"]), (&"Job".into(), &"Indexed".into()));
    assert_eq!(spec["completions"].as_u64(), Some(PARTS as u64));
    let (name, parts) = (&container["env"][0]["name"], &container["env"][0]["value"]);
    assert_eq!((name.as_str(), parts.as_str()), (Some("PARTS"), Some(PARTS.to_string().as_str())));
    let workshop = fleet();
    fs::create_dir(workshop.path("secret")).unwrap();
    fs::copy(workshop.path("factory.key"), workshop.path("secret/factory.key")).unwrap();
    // Where the pod has mounts, the workshop has folders.
    let script = container["args"][0].as_str().unwrap().replace("/secret/", "secret/").replace("/tmp/", "pod-");
    for index in 0..PARTS {
        let mut command = shell(&workshop, &script);
        command.env("JOB_COMPLETION_INDEX", index.to_string()).env("PARTS", parts.as_str().unwrap());
        programs::output(command);
    }
    whole(&workshop);
}
