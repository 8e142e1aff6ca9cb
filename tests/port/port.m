function port(what, varargin)
% A port to MATLAB and Octave in two dimensions: linear basis or local max-ent in a box, lumped
% mass, Newmark's predictor-corrector, for the strip of the conformance kit. It prints the
% columns that `lme-mpm check` reads:
%
%   port('trace', STEPS, GAMMA, NAME, VALUE, ...)   GAMMA = 0 is the linear basis
%   port('basis', FILE, GAMMA, CELLS_X, CELLS_Y)    answers a file of level 0
%   port('law', FILE)
%
% The first changes the strip where it is told to, with the names of `strip` below. Nodes and
% particles are counted from 1 here, and from 0 in what is printed.
fprintf('k,step,symbol,index,node,component,value\n');
switch what
  case 'trace'
    s = strip();
    for n = 3:2:numel(varargin), s.(varargin{n}) = varargin{n + 1}; end
    march(s, varargin{1}, varargin{2});
  case 'basis'
    [x, h] = given_places(varargin{1});
    [T, lambda] = table(x, h, [varargin{3:4}], varargin{2});
    print_table(0, 2, T, lambda);
  case 'law'
    law_of_file(varargin{1});
end
end

function s = strip()
% What strip.toml says. A side holds the components in its list: left, right, bottom, top.
s.length = [1.5 0.6]; s.rho = 1000; s.E = 1e6; s.nu = 0.3;
s.cells = [3 2]; s.per_cell = [1 2]; s.cfl = 0.4; s.T = 0.03;
s.held = {[1 2], [], 2, []};
s.from = 0.75; s.thrown = [4 -2]; s.b = [20 -50];
s.right = [4e4 2e4]; s.top = [-1e4 3e4]; s.ramp = 0.01;
end

% --- Shape functions ---

function [T, lambda] = table(x, h, cells, gamma)
% N and both slopes of every particle (rows) at every node (columns), and which nodes it sees.
nodes = prod(cells + 1);
T.N = zeros(size(x, 1), nodes); T.G = {T.N, T.N}; T.seen = false(size(T.N));
lambda = zeros(size(x));
for p = 1:size(x, 1)
  for d = 1:2
    [N{d}, slope{d}, seen{d}, lambda(p, d)] = axis_functions(x(p, d), h(d), cells(d), gamma);
  end
  T.N(p, :) = kron(N{2}, N{1});             % x fastest
  T.G{1}(p, :) = kron(N{2}, slope{1});
  T.G{2}(p, :) = kron(slope{2}, N{1});
  T.seen(p, :) = kron(seen{2}, seen{1}) > 0;
end
if gamma == 0, lambda = []; end
end

function [N, slope, seen, lambda] = axis_functions(x, h, cells, gamma)
% Along one axis: the functions of all its nodes, 0 where they are not seen.
node = (0:cells) * h;
i = min(floor(x / h), cells - 1);
if x < node(i + 1), i = i - 1; end
if x >= node(i + 2) && i < cells - 1, i = i + 1; end
N = zeros(1, cells + 1); slope = N; lambda = 0;
cell = [i + 1, i + 2];
at = (x - node) / h;                         % xi of every node
seen = false(size(N)); seen(cell) = true;
if gamma == 0 || x == node(1) || x == node(end)   % on the hull: the limit from inside
  if gamma > 0, seen = seen | abs(at) <= sqrt(-log(1e-6) / gamma); end
  N(cell) = [1 - at(cell(1)), at(cell(1))];
  slope(cell) = [-1 1] / h;
  return
end
seen = seen | abs(at) <= sqrt(-log(1e-6) / gamma);
xi = at(seen); l = 0;                        % (31) to (37) with xi, gamma and lambda h
for n = 1:200
  f = -gamma * xi.^2 + l * xi;
  w = exp(f - max(f)); w = w / sum(w);
  r = sum(w .* xi);
  J = sum(w .* (xi - r).^2);
  step = r / J;
  l = l - step / max(1, 2 * max(abs(step * (xi - r))));   % no weight changes by more than a half
  if abs(step) < 1e-15 * max(1, abs(l)), break, end
end
N(seen) = w;
slope(seen) = -w .* xi / J / h;              % (35), where r = 0
lambda = l / h;
end

% --- The law: plane strain ---

function ds = stress_of(de, E, nu)
% (3) for rows xx, xy, yx, yy.
first = E * nu / ((1 + nu) * (1 - 2 * nu)); mu = E / (2 * (1 + nu));
ds = 2 * mu * de + first * (de(:, 1) + de(:, 4)) * [1 0 0 1];
end

% --- The nine steps ---

function march(s, steps, gamma)
h = s.length ./ s.cells;
beyond = [isempty(s.held{2}), isempty(s.held{4})];   % before the body there is none: both hold
before = [isempty(s.held{1}), isempty(s.held{3})];
assert(~any(before), 'cells before the body are not in this port');
cells = s.cells + beyond;
M = s.E * (1 - s.nu) / ((1 + s.nu) * (1 - 2 * s.nu)); c = sqrt(M / s.rho);
dt = s.T / ceil(s.T * c / (s.cfl * min(h)) * (1 - 1e-9));
% Particles, x fastest across the body.
count = s.cells .* s.per_cell;
place = @(d) (floor((0:count(d) - 1) / s.per_cell(d)) ...
  + (mod(0:count(d) - 1, s.per_cell(d)) + 0.5) / s.per_cell(d)) * h(d);
[X, Y] = ndgrid(place(1), place(2)); x = [X(:) Y(:)];
share = h ./ s.per_cell; np = size(x, 1);
m = s.rho * prod(share) * ones(np, 1); rho = s.rho * ones(np, 1);
v = (x(:, 1) >= s.from) * s.thrown; sigma = zeros(np, 4);
% Tractions act on the outermost layers, over the share of the other axis.
[QX, QY] = ndgrid(1:count(1), 1:count(2));
pull = (QX(:) == count(1)) * s.right * share(2) + (QY(:) == count(2)) * s.top * share(1);
held = held_nodes(s, cells);
print(0, 0, 'dt', dt); print(0, 0, 'E', s.E); print(0, 0, 'nu', s.nu); print(0, 0, 'h', h);
if gamma > 0, print(0, 0, 'gamma', gamma); end
print(0, 0, 'm_p', m); print(0, 0, 'x_p', x); print(0, 0, 'rho_p', rho);
print(0, 0, 'sigma_p', sigma); print(0, 0, 'v_p', v);

vI = zeros(prod(cells + 1), 2); a = zeros(np, 2); T.N = zeros(np, prod(cells + 1));
for k = 0:steps
  D = dt * (k > 0);
  x = x + T.N * vI * D + a * (D^2 / 2);               % 1: (27), (28)
  v = v + a * (D / 2);
  print(k, 1, 'x_p', x); print(k, 1, 'v_p', v);
  [T, lambda] = table(x, h, cells, gamma);            % 2
  print_table(k, 2, T, lambda);
  mI = T.N' * m; pI = T.N' * (m .* v);                % 3
  print(k, 3, 'm_I', mI); print(k, 3, 'p_I', pI);
  pI(held) = 0;                                       % 4
  per_m = zeros(size(mI)); per_m(mI > 0) = 1 ./ mI(mI > 0);
  vI = pI .* per_m;
  print(k, 4, 'v_I', vI);
  de = D * strain_rate(T, vI, mI);                    % 5: (16)
  print(k, 5, 'd_eps_p', de);
  rho = rho ./ (1 + de(:, 1) + de(:, 4));             % 6: (17), (3)
  sigma = sigma + stress_of(de, s.E, s.nu);
  print(k, 6, 'rho_p', rho); print(k, 6, 'sigma_p', sigma);
  V = m ./ rho;                                       % 7: (14), (15)
  fint = -[T.G{1}' * (V .* sigma(:, 1)) + T.G{2}' * (V .* sigma(:, 2)), ...
           T.G{1}' * (V .* sigma(:, 3)) + T.G{2}' * (V .* sigma(:, 4))];
  fext = T.N' * (m * s.b) + T.N' * pull * min(k * dt / s.ramp, 1);
  fI = fint + fext; fI(held) = 0;
  print(k, 7, 'f_int_I', fint); print(k, 7, 'f_ext_I', fext); print(k, 7, 'f_I', fI);
  pI = pI + fI * (D / 2);                             % 8
  vI = pI .* per_m;
  print(k, 8, 'p_I_advanced', pI);
  a = T.N * (fI .* per_m);                            % 9: (29)
  v = v + a * (D / 2);
  print(k, 9, 'a_p', a); print(k, 9, 'v_p', v);
end
end

function held = held_nodes(s, cells)
% True where a component is held: on the side and beyond it.
[i, j] = ndgrid(0:cells(1), 0:cells(2));
on = {i(:) <= 0, i(:) >= s.cells(1), j(:) <= 0, j(:) >= s.cells(2)};
held = false(numel(i), 2);
for side = 1:4, held(on{side}, s.held{side}) = true; end
end

function rate = strain_rate(T, vI, mI)
% (16) by rows. A node without mass moves with the particle's first node that has some.
rate = zeros(size(T.N, 1), 4);
for p = 1:size(T.N, 1)
  I = find(T.seen(p, :) & mI' > 0);
  dv = vI(I, :) - vI(I(1), :);
  L = dv' * [T.G{1}(p, I)', T.G{2}(p, I)'];           % row: velocity, column: slope
  rate(p, :) = [L(1, 1), (L(1, 2) + L(2, 1)) / 2, (L(1, 2) + L(2, 1)) / 2, L(2, 2)];
end
end

% --- Files ---

function print(k, step, symbol, values)
% One row of `values` for each particle or node, one column for each component.
for n = 1:size(values, 1)
  for c = 1:size(values, 2)
    fprintf('%d,%d,%s,%d,,%d,%.17g\n', k, step, symbol, n - 1, c - 1, values(n, c));
  end
end
end

function print_table(k, step, T, lambda)
for p = 1:size(T.N, 1)
  for I = find(T.seen(p, :))
    fprintf('%d,%d,N_Ip,%d,%d,0,%.17g\n', k, step, p - 1, I - 1, T.N(p, I));
    for c = 1:2
      fprintf('%d,%d,grad_N_Ip,%d,%d,%d,%.17g\n', k, step, p - 1, I - 1, c - 1, T.G{c}(p, I));
    end
  end
end
print(k, step, 'lambda', lambda);
end

function given = read_given(file)
% Lines of step 0: k, symbol, index, component, value.
id = fopen(file); fgetl(id); given = {};
line = fgetl(id);
while ischar(line)
  part = strsplit(line, ',', 'CollapseDelimiters', false);
  if strcmp(part{2}, '0')
    number = @(n) str2double(part{n});
    given(end + 1, :) = {number(1), part{3}, number(4), number(6), number(7)};
  end
  line = fgetl(id);
end
fclose(id);
end

function [x, h] = given_places(file)
given = read_given(file);
for n = 1:size(given, 1), x(given{n, 3} + 1, given{n, 4} + 1) = given{n, 5}; end
h = [0.5 0.25];                                       % the grid of level 0
end

function law_of_file(file)
given = read_given(file);
for k = 0:max([given{:, 1}])
  own = given([given{:, 1}] == k, :);
  of = @(symbol) [own{strcmp(own(:, 2), symbol), 5}];
  de = of('d_eps_p'); sigma = stress_of(de, of('E'), of('nu'));
  print(k, 6, 'rho_p', 1 / (1 + de(1) + de(4))); print(k, 6, 'sigma_p', sigma);
  print(k, 6, 'W_p', sum(sigma .* de) / 2);
end
end
