// Flamenco 3 job type: remeshes the assets of a list in chunks, then writes one summary.
//
// Put this file into the folder "scripts" beside the Flamenco Manager. Before a job is submitted, freeze the list, so that
// all workers number the assets alike:
//
//     hybrid-quad batch /shared/assets --quads 5000 --output /shared/quads --write-list /shared/jobs.jsonl
//
// An asset that cannot be remeshed is no failed task: its status file and the summary say so. Tasks fail only where a
// machine lets nothing run; Flamenco then tries again elsewhere. It cancels a job in which a tenth of the tasks failed, and
// a task's timeout notices dead workers only, so limits of an asset's own are among the settings here.

const JOB_TYPE = {
    label: "Hybrid Quad: Remesh Many",
    description: "Remeshes all assets of a list into pure quads",
    settings: [
        { key: "job_list", type: "string", required: true, subtype: "file_path",
          description: "Job file, the same path on every worker; made by hybrid-quad batch --write-list" },
        { key: "output", type: "string", required: true, subtype: "dir_path",
          description: "Folder for results, status files and the summary" },
        { key: "assets", type: "string", required: true,
          description: "Numbers of the assets, from 0, both ends included: 0-999" },
        { key: "chunk_size", type: "int32", default: 20, propargs: { min: 1 },
          description: "Assets in one task", visible: "submission" },
        { key: "jobs", type: "int32", default: 1, propargs: { min: 1 },
          description: "Assets at a time on one worker", visible: "submission" },
        { key: "time_limit", type: "int32", default: 1800, propargs: { min: 1 },
          description: "Seconds that one asset may take", visible: "submission" },
        { key: "memory_limit", type: "int32", default: 8000, propargs: { min: 1 },
          description: "Megabytes that one asset may take", visible: "submission" },
        { key: "most_failed_percent", type: "int32", default: 100, propargs: { min: 0, max: 100 },
          description: "The summary's task fails where more assets than this have no result", visible: "submission" },
        { key: "program", type: "string", default: "hybrid-quad", visible: "submission",
          description: "The command on the workers" },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    const summary = author.Task("summary", "misc");
    summary.addCommand(author.Command("exec", {
        exe: settings.program,
        args: batchArguments(settings, ["--summary-only", "--fail-above", String(settings.most_failed_percent)]),
    }));
    for (const chunk of frameChunker(settings.assets, settings.chunk_size)) {
        const task = author.Task(`assets ${chunk}`, "misc");
        task.addCommand(author.Command("exec", {
            exe: settings.program,
            args: batchArguments(settings, [
                "--range", chunk,
                "--jobs", String(settings.jobs),
                "--time-limit", String(settings.time_limit),
                "--memory-limit", String(settings.memory_limit),
            ]),
        }));
        summary.addDependency(task);
        job.addTask(task);
    }
    job.addTask(summary);
}

function batchArguments(settings, others) {
    return ["batch", settings.job_list, "--output", settings.output, ...others];
}
