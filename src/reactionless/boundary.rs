use super::*; use crate::planar::Vector;
#[derive(Clone,Debug)] pub struct Boundary { pts: Vec<([f64;2],Vector)>, map: PlaneMap }
#[derive(Clone,Copy,Debug)] pub struct Nearest { pub at: Vector, pub a:[f64;2], pub distance: f64 }
impl Boundary { pub fn of(map:&PlaneMap)->Self{ let l=map.limits(); let n=200; let mut pts=vec![]; for e in 0..4 { for i in 0..n { let t=i as f64/n as f64; let (s,u)=match e {0=>(t,0.0),1=>(1.0,t),2=>(1.0-t,1.0),_=>(0.0,1.0-t)}; let a=[l[0].min+(l[0].max-l[0].min)*s,l[1].min+(l[1].max-l[1].min)*u]; pts.push((a,map.forward_unturned(a))); } } Self{pts,map:*map} }
pub fn area(&self)->f64 { let n=self.pts.len(); (0..n).map(|i| crate::planar::cross(self.pts[i].1,self.pts[(i+1)%n].1)).sum::<f64>().abs()/2.0 }
pub fn nearest(&self,p:Vector,b:f64,_from:Vector)->Nearest{ let g=p*crate::planar::unit(-self.map.turn(b)); let (a,q)=self.pts.iter().min_by(|x,y| (x.1-g).norm().total_cmp(&(y.1-g).norm())).unwrap(); Nearest{at:*q*crate::planar::unit(self.map.turn(b)),a:*a,distance:(*q-g).norm()} }
pub fn turned(&self,b:f64)->Vec<Vec<[f64;2]>>{ let r=crate::planar::unit(self.map.turn(b)); vec![self.pts.iter().map(|(_,p)| {let z=p*r; [z.re,z.im]}).collect()] } }
