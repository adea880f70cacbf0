-- Functions that create the servers of a simulation with their usual helpers. A config calls
--
--     include "house.lua"
--     files() scene() physics() simulation()      -- in this order
--     agents{ port = 3100 }
--     monitors{ port = 3200 }
--     web()
--     control() drawing()
--
-- and adds its own nodes. Each function loads the plugins it needs, builds one server with its helpers, and returns the
-- server, so that a config can set properties or swap a helper. A config may also write the same lines itself.
--
-- `host` describes the program that runs the config: host.share (the folder with lua/ and scenes/, "" when there is
-- none), host.scenePaths (folders from --scene-path) and host.alone (true in a batch). Programs that embed the kernel
-- may omit it.
host = host or { share = "", scenePaths = {} }

--- File server. Folders given by --scene-path contain rsg/... and are searched before the scenes that come with Spark.
function files()
  plugin "files"
  local server = new("FileServer", "/sys/server/file")
  for i, folder in ipairs(host.scenePaths) do
    new("DirectoryFileSystem", "/sys/server/file/scenePath" .. i).path = folder
  end
  if host.share ~= "" then
    local share = new("DirectoryFileSystem", "/sys/server/file/share")
    share.path = host.share .. "/scenes"
    share.prefix = "rsg"                        -- scenes/agent/sphere.rsg is known as rsg/agent/sphere.rsg
  end
  return server
end

--- Scene server with the importers of RSG, MJCF, URDF, Webots and 3D models, and an empty active scene at
--- /usr/scene. `--set transactionalImport=true` makes all imports that fail leave the scene unchanged.
function scene()
  local transactional = option{ name = "transactionalImport", default = "byLanguage",
                                choices = { "byLanguage", "true", "false" },
                                doc = "Imports that fail leave the scene unchanged; by language: all but those of " ..
                                      "scene files of the installed base." }
  plugin "scene"
  plugin "scene-rsg"
  plugin "scene-mjcf"
  plugin "scene-urdf"
  plugin "scene-webots"
  plugin "scene-meshes"
  local server = new("SceneServer", "/sys/server/scene")
  server.transactionalImport = transactional
  new("RsgImporter", "/sys/server/scene/rsg")
  new("MjcfImporter", "/sys/server/scene/mjcf")
  new("UrdfImporter", "/sys/server/scene/urdf")
  new("WebotsImporter", "/sys/server/scene/webots")
  new("MeshImporter", "/sys/server/scene/meshes")
  new("Scene", "/usr/scene")
  return server
end

-- Loads the plugin that provides a class, whoever wrote it. Without one, new() says so.
local function provide(class)
  for _, found in ipairs(get("/plugins"):children()) do
    for _, name in ipairs(found.classes) do
      if name == class then plugin(found.name) end
    end
  end
end

--- Physics server with collision detection and engine, and a world with a space in the active scene. `engine`: class of
--- the engine, of any plugin; OdeEngine by default. `properties`: properties of the server, set before the world is
--- created.
function physics(engine, properties, more)
  if more then error("physics(engine, properties): name the engine, such as physics(\"ArticulatedEngine\")", 2) end
  plugin "physics"
  plugin "physics-ode"
  local server = new("PhysicsServer", "/sys/server/physics")
  for name, value in pairs(properties or {}) do server[name] = value end
  new("OdeCollision", "/sys/server/physics/collision")    -- for engines that do not find contacts themselves
  provide(engine)
  local node = new(engine or "OdeEngine", "/sys/server/physics/engine")
  if engine == "ArticulatedEngine" then node:new("OdeEngine", "deferred") end
  new("World", "/usr/scene/world")
  new("Space", "/usr/scene/space")
  return server
end

--- The engine class selected by --set solver=... or --set engine=..., for physics(). `default`: the default of
--- `solver`, "dense" if omitted.
function engineOption(default)
  local solver = option{ name = "solver", default = default or "dense", choices = { "dense", "articulated" },
                         doc = "dense: ODE's own, which repeats recorded sessions; articulated: the same physics, " ..
                               "many times faster for robots." }
  local engine = option{ name = "engine", default = solver == "articulated" and "ArticulatedEngine" or "OdeEngine",
                         doc = "Class of the engine, in place of the one that `solver` means." }
  return engine
end

--- The run loop, which emits the phases; sparkhost calls its run().
function simulation()
  plugin "simulation"
  return new("Simulation", "/sys/server/simulation")
end

-- One port with its framing. `consumer` is the path of the server that receives the messages. `socket`: file of a Unix
-- socket that takes the place of the TCP port.
local function listeningPort(name, port, consumer, framing, socket)
  plugin "net-tcp"
  if not get("/sys/server/net") then new("NetServer", "/sys/server/net") end
  local onTcp = (socket or "") == ""
  local node = new(onTcp and "TcpPort" or "UnixPort", "/sys/server/net/" .. name)
  new(framing or "LengthPrefixFraming", "/sys/server/net/" .. name .. "/framing")
  node.consumer = consumer
  if onTcp then node.port = port else node.file = socket end
  return node
end

-- Every config loads both languages, so that --set parser=JsonParser is sufficient.
local function languages()
  plugin "parser-sexp"
  plugin "parser-json"
end

--- A port for agents; a second one may speak another language: the port's own parser wins over game control's.
--- `framing`: class that cuts bytes into messages; `socket`: file of a Unix socket in place of TCP.
function agentPort(name, port, parser, framing, socket)
  local node = listeningPort(name, port, "/sys/server/gamecontrol", framing, socket)
  node.makeRoom = true                         -- agents send first: one that does not may be closed to admit others
  if parser then new(parser, "/sys/server/net/" .. name .. "/parser") end
  return node
end

--- Game control, the timing of agents and the agent port. `parser`: class of the agents' language; `decimals`: of the
--- numbers that agents get; -1, the default: as many as it takes to read back the same number.
function agents(t)
  languages()
  plugin "gamecontrol"
  local server = new("GameControl", "/sys/server/gamecontrol")
  local language = new(t.parser or "SexpParser", "/sys/server/gamecontrol/parser")
  if language.class == "SexpParser" or language.class == "JsonParser" then language.decimals = t.decimals or -1 end
  local timing = new("AgentTiming", "/sys/server/gamecontrol/timing")
  timing.senseLatency = option{ name = "senseLatency", default = timing.senseLatency,
                                doc = "Cycles from sensing to the arrival of percepts." }
  timing.actLatency   = option{ name = "actLatency", default = timing.actLatency,
                                doc = "Cycles by which actions take effect later than without latency." }
  local framing = option{ name = "agentFraming", default = "LengthPrefixFraming",
                          doc = "How bytes become messages: LengthPrefixFraming, or LineFraming, one per line." }
  local socket  = option{ name = "agentSocket", default = "",
                          doc = "Unix socket for agents of this machine, in place of the TCP port; empty: TCP." }
  agentPort("agents", t.port or 3100, nil, framing, socket)
  return server
end

--- Agents as in the middleware SPADES, in place of agents{}: the host starts them from an agent database, and their
--- sensations and acts have latencies and think times in simulated time. `types`: names of agent types, with `players`
--- agents of each; `parser`: class of their language; `effector`: class of the effector that they have from the start.
function spades(t)
  local database = option{ name = "agentDatabase", default = "", doc = "XML file that says which programs are agents." }
  local logs     = option{ name = "agentLogs", default = "", doc = "Folder for what agents print; empty: none." }
  local think    = option{ name = "thinkTime", default = "FixedThinkTime",
                           doc = "Think time: FixedThinkTime, or measured: CpuThinkTime, InstructionThinkTime." }
  local port     = option{ name = "commPort", default = -1,
                           doc = "TCP port for sparkcomm on other machines; 0: a free one, -1: none." }
  local address  = option{ name = "commAddress", default = "127.0.0.1",
                           doc = "Where it listens; 0.0.0.0: for the whole network, unencrypted." }
  local token    = option{ name = "commToken", default = "", secret = true,
                           doc = "What they must know; empty: nothing." }
  local servers  = option{ name = "commServers", default = 0, doc = "How many of them the start waits for." }
  languages()
  plugin "gamecontrol"
  plugin "simulation-spades"
  local server = new("SpadesServer", "/sys/server/spades")
  new(think, "/sys/server/spades/think")
  local control = new("GameControl", "/sys/server/gamecontrol")
  control.createEffector = t.effector or "SceneEffector"
  new(t.parser or "SexpParser", "/sys/server/gamecontrol/parser")
  local schedule = new("SenseSchedule", "/sys/server/gamecontrol/schedule")
  server.logs, server.port, server.address, server.commServers = logs, port, address, servers
  server:setToken(token)
  if database ~= "" then server.database = database end
  local count = 0
  for type in (t.types or ""):gmatch("%S+") do
    server:queueAgents(type, t.players)
    count = count + t.players
  end
  schedule.agents = math.max(count, 1)
  return server
end

--- Monitor server and the monitor port. `encoder`: class of the monitors' language.
function monitors(t)
  plugin "monitor"
  plugin "monitor-sexp"
  plugin "monitor-json"
  local server = new("MonitorServer", "/sys/server/monitor")
  new(t.encoder or "SexpMonitor", "/sys/server/monitor/encoder")
  local framing = option{ name = "monitorFraming", default = "LengthPrefixFraming",
                          doc = "The same for monitors: LengthPrefixFraming or LineFraming." }
  local socket  = option{ name = "monitorSocket", default = "",
                          doc = "File of a Unix socket for monitors, in place of the TCP port; empty: TCP." }
  local port = listeningPort("monitors", t.port or 3200, "/sys/server/monitor", framing, socket)
  port.maxConnections = 128
  -- Clients that never read are allowed, but 128 of them do not block others.
  port.makeRoomAfter = 10
  return server
end

--- Sounds for monitors and the page: SoundHandlers below colliders, and sounds:play("whistle", 1, { 0, 0, 1 }). Call it
--- after monitors() or web(); simulations without a monitor server, such as those of a batch, are silent.
function soundServer()
  plugin "sounds"
  return get("/sys/server/monitor") and new("Sounds", "/sys/server/monitor/sounds")
end

--- The web page that shows the match: `--set web=false` disables it, `--set webPort=0` selects a free port, `--set
--- webLogs=FOLDER` lets the viewer play recorded games. Call it after monitors(); without monitors(), it creates a
--- monitor server without a port. Simulations of a batch have no page.
function web()
  local wanted = option{ name = "web", default = true, doc = "The match can be watched in a browser." }
  local port   = option{ name = "webPort", default = 3280, doc = "Its port; 0: a free one." }
  local address = option{ name = "webAddress", default = "127.0.0.1",
                          doc = "Where it listens; 0.0.0.0: for the whole network, unencrypted." }
  local token  = option{ name = "webToken", default = "", secret = true,
                         doc = "What makes a viewer a referee, at least 16 characters; empty: made up and printed." }
  local logs   = option{ name = "webLogs", default = "",
                         doc = "Folder of recorded games that viewers may play; empty: none." }
  if host.alone or not wanted then return end
  plugin "monitor-web"
  plugin "monitor"
  if not get("/sys/server/monitor") then new("MonitorServer", "/sys/server/monitor") end
  local server = new("WebServer", "/sys/server/web")
  if host.share ~= "" then server.viewer = host.share .. "/viewer" end
  server.address, server.port, server.logs = address, port, logs
  server:setToken(token)
  new("WebMonitor", "/sys/server/monitor/web")
  return server
end

--- The log server: sparkctl sets the log's level at run time. `--set logFile=match.log` writes the log to a file as
--- well, `--set logLines=500` keeps the last messages for sparkctl. Simulations of a batch have no log of their own.
function logs()
  local file  = option{ name = "logFile", default = "", doc = "File that gets the log, too; it rotates." }
  local lines = option{ name = "logLines", default = 0, doc = "How many log messages are kept for sparkctl." }
  if host.alone then return end
  plugin "logserver"
  local server = get("/sys/server/log") or new("LogServer", "/sys/server/log")
  if file ~= "" and not server:find("file") then server:new("FileLogSink", "file").file = file end
  if lines > 0 and not server:find("memory") then server:new("MemoryLogSink", "memory").capacity = lines end
  return server
end

--- The server that lets other hosts mount this one's tree: --set remoteAddress=127.0.0.1:3400, or the path of a Unix
--- socket. control() calls it. Simulations of a batch have none.
function remote()
  local address = option{ name = "remoteAddress", default = "",
                          doc = "Where other hosts mount this one's tree: host:port or a Unix socket; empty: nowhere." }
  local token   = option{ name = "remoteToken", default = "", secret = true,
                          doc = "What they must know, at least 16 characters; empty: made up and printed." }
  local expect  = option{ name = "remoteExpect", default = 0, doc = "How many of them the first cycle waits for." }
  if host.alone or address == "" then return end
  plugin "remote"
  local server = get("/sys/server/remote") or new("RemoteServer", "/sys/server/remote")
  server.expect = expect
  server:listen(address, token)
  local at, word = server.address, server:token()
  -- As the page's link: recordings of the log leave out what follows the mark.
  if at ~= "" then log.info("other hosts mount this one at " .. at .. (word ~= "" and "#token=" .. word or "")) end
  return server
end

--- A part of another host's tree in this one: mount{ "/usr/match", address = "127.0.0.1:3400", token = "..." }. `of`:
--- the node there whose children appear here, "/" by default; `name`: how this host introduces itself; `waits` false:
--- the other host does not wait for handlers here.
function mount(t)
  if type(t) ~= "table" or type(t[1]) ~= "string" then
    error('mount: expected the path of the new node first, as in mount{ "/usr/match", address = "127.0.0.1:3400" }', 2)
  end
  if type(t.address) ~= "string" or t.address == "" then
    error("mount: expected an address, host:port or a Unix socket, found " .. tostring(t.address), 2)
  end
  plugin "remote"
  if not get("/sys/server/remote") then new("RemoteServer", "/sys/server/remote") end
  local node = new("RemoteMount", t[1])
  local good, why = pcall(function()
    node.address, node.of, node.clientName, node.waits = t.address, t.of or "/", t.name or "remote", t.waits ~= false
    node:connect(t.token or "")
  end)
  if good then return node end
  node:delete() -- a config that goes on must not find it
  error((tostring(why):gsub("^house%.lua:%d+: ", "")), 2)
end

--- The socket of sparkctl, which only the host's own user can open. The socket and the page answer requests about
--- contacts, joint angles and percepts. Simulations of a batch have no socket. It makes a log server, too.
function control()
  logs()
  remote()
  if host.alone then return end
  plugin "control"
  plugin "inspect"
  local server = new("ControlServer", "/sys/server/control")
  new("Inspector", "/sys/server/control/inspect")
  return server
end

--- Drawings of agents for viewers: --set drawings=32769 opens the UDP port of the installed base's viewer, --set
--- forwardDrawings=host:port forwards all packets to another one. Simulations of a batch keep no drawings, but robots
--- may have the effector.
function drawing()
  local port = option{ name = "drawings", default = -1,
                       doc = "UDP port at which agents' drawings come in, e.g. 32769; -1: none, 0: any free one." }
  local forward = option{ name = "forwardDrawings", default = "",
                          doc = "host:port of another viewer that gets agents' drawings too." }
  plugin "drawing"
  if host.alone then return end
  local server = new("DrawingServer", "/sys/server/drawing")
  server.port, server.forward = port, forward
  return server
end

--- Pictures for the cameras of robots (ImagePerceptor), which sense nothing without it. They are drawn on the
--- processor. Call it after materials(), if at all: meshes that only viewers have then get colours.
function camera()
  plugin "camera"
  if meshColours and get("/sys/server/material") then meshColours(get("/sys/server/material")) end
  return new("CameraServer", "/sys/server/camera")
end

--- The status of a game: Status.score = {2, 1}. The host's status line, the columns of a batch and the page show it.
--- `values`: initial values; playMode (text), score (numbers) and teams (names) have a meaning, all others are shown by
--- their names.
function status(values)
  plugin "scene"
  local group = new("StatusVariables", "/sys/variables/Status")
  for name, value in pairs(values or {}) do group:set(name, value) end
  return group
end

--- The results of a run: Result.falls = 3. sparkbatch writes a column for each. `values`: initial values.
function results(values)
  plugin "scene"
  local group = new("Variables", "/sys/variables/Result")
  for name, value in pairs(values or {}) do group:set(name, value) end
  return group
end
